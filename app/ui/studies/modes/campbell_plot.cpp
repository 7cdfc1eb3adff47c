#include "app/ui/studies/modes/campbell_plot.hpp"

#include "app/plot/campbell_plot.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "app/ui/studies/modes/critical_speeds.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/drive_speed.hpp"

#include <algorithm>
#include <numbers>

namespace flyball {

void draw_campbell(const Session& session, CampbellView& drawn) {
  const CampbellState& campbell = session.study.modes.campbell;

  const CampbellView::Of shown{campbell.diagram.found,
                               session.study.modes.list.found,
                               session.answer.ticket,
                               session.study.modes.chosen,
                               drawn.hertz,
                               session.units};
  if (drawn.of == shown) return;
  if (!campbell.diagram.found || solving(session)) return; // the answer belongs to other numbers
  drawn.of = shown;
  const CampbellRequest& of = campbell.diagram.found->of;
  const std::string unit = parameter_unit(*of.mechanism, of.drive);
  const PlotRange range{std::min(of.from, of.to), std::max(of.from, of.to)};
  const ShownUnit shown_as = shown_unit(unit, session.units);
  drawn.unit = shown_unit("rad/s", session.units);
  drawn.critical.reset();
  Plot plot;
  if (const std::optional<CampbellPlace> place = campbell_place(session)) {
    const CampbellDiagram& diagram = campbell.diagram.found->result;
    const std::vector<std::string> names = campbell_names(session, *place);
    plot =
        campbell_plot(*of.mechanism, of.drive, diagram, place->branch, names, range, of.orders, drawn.hertz);
    if (!DriveSpeed(*of.mechanism, of.drive).joint().empty())
      drawn.critical = critical_rows(diagram, place->branch, names, drawn.unit);
    drawn.without_modes = left_out(
        diagram.response.branches[place->branch],
        [&](double value) { return short_text(shown_as.shown(value), 6); }, shown_as.text);
  } else {
    plot.x = {.label = {}, .unit = unit, .range = range, .room = 0};
    plot.y = {.label = "frequency", .unit = drawn.hertz ? "Hz" : "rad/s"};
    drawn.without_modes.clear();
  }
  plot.x.label = parameter_phrase(of.drive);
  if (converged(session)) {
    const double value = get_parameter(session.mechanism(), of.drive);
    plot.references.push_back({.axis = 0, .at = value, .label = "now", .color = plot_color::blue});
    if (const VibrationMode* mode = moving_mode(session);
        mode && modes_are_current(session) && mode->oscillates())
      plot.marker = PlotMarker{value * shown_as.factor,
                               mode->frequency * (drawn.hertz ? 1 / (2 * std::numbers::pi) : 1), ""};
  }
  show_axis(plot, 0, unit, session.units);
  replace_plot(drawn.plot, std::move(plot));
}

std::string campbell_problem(const Session& session) {
  const auto& diagram = session.study.modes.campbell.diagram;
  std::string text = diagram.problem;
  if (!diagram.found) return text;
  const CampbellRequest& of = diagram.found->of;
  const std::string si = parameter_unit(*of.mechanism, of.drive);
  const ShownUnit unit = shown_unit(si, session.units);
  const std::string value = " = " + rounded_text(of.from, 6) + " " + si;
  if (const std::size_t at = text.find(value); at != std::string::npos)
    text.replace(at, value.size(), " = " + short_text(unit.shown(of.from), 6) + " " + unit.text);
  return with_phrase(std::move(text), of.drive);
}

} // namespace flyball
