#include "app/ui/studies/modes/campbell_plot.hpp"

#include "app/plot/campbell_plot.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <numbers>

namespace flyball {

void draw_campbell(App& app) {
  const CampbellState& campbell = app.study.modes.campbell;
  CampbellView& drawn = app.plots.campbell;
  const CampbellView::Of shown{campbell.diagram.found,
                               app.study.modes.list.found,
                               app.answer.ticket,
                               app.study.modes.chosen,
                               drawn.hertz,
                               app.units};
  if (drawn.of == shown) return;
  if (!campbell.diagram.found || solving(app)) return; // the answer belongs to other numbers
  drawn.of = shown;
  const CampbellRequest& of = campbell.diagram.found->of;
  const std::string unit = parameter_unit(app.mechanism(), of.drive);
  const PlotRange speeds{std::min(of.from, of.to), std::max(of.from, of.to)};
  Plot plot;
  if (const std::optional<std::size_t> branch = campbell_branch(app)) {
    plot = campbell_plot(app.mechanism(), of.drive, campbell.diagram.found->result, *branch, speeds,
                         of.orders, drawn.hertz);
  } else {
    plot.x = {.label = {}, .unit = unit, .range = speeds, .room = 0};
    plot.y = {.label = "frequency", .unit = drawn.hertz ? "Hz" : "rad/s"};
  }
  plot.x.label = parameter_phrase(of.drive);
  if (converged(app)) {
    const double speed = get_parameter(app.mechanism(), of.drive);
    plot.references.push_back({.axis = 0, .at = speed, .label = "now", .color = plot_color::blue});
    if (const VibrationMode* mode = moving_mode(app); mode && modes_are_current(app) && mode->oscillates())
      plot.marker = PlotMarker{speed * shown_unit(unit, app.units).factor,
                               mode->frequency * (drawn.hertz ? 1 / (2 * std::numbers::pi) : 1), ""};
  }
  show_axis(plot, 0, unit, app.units);
  replace_plot(drawn.plot, std::move(plot));
}

} // namespace flyball
