#include "app/ui/studies/modes/campbell_plot.hpp"

#include "app/plot/campbell_plot.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <numbers>

namespace flyball {

namespace {

// "Critical speeds: 1× mode 1, arm1 at 3.34761 rad/s; ... (each ± 6e-15 rad/s)" on the branch that is shown.
std::string critical_words(const CampbellDiagram& diagram, std::size_t branch, const ShownUnit& unit) {
  std::string text;
  double error = 0;
  for (const CriticalSpeed& at : diagram.critical)
    if (at.branch == static_cast<int>(branch)) {
      text += (text.empty() ? "Critical speeds: " : "; ") + order_text(at.order) + " " +
              diagram.branches[branch].names[static_cast<std::size_t>(at.line)] +
              (at.until ? " runs along from " : " at ") + short_text(unit.shown(at.speed), 6) +
              (at.until ? " to " + short_text(unit.shown(*at.until), 6) : "") + " " + unit.text +
              (at.touches ? ", only touching" : "");
      error = std::max(error, at.error);
    }
  return text.empty() ? "No critical speed in this range."
                      : text + " (each ± " + short_text(unit.shown(error), 1) + " " + unit.text + ").";
}

} // namespace

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
  const PlotRange speeds{std::min(of.from, of.to), std::max(of.from, of.to)};
  Plot plot;
  if (const std::optional<std::size_t> branch = campbell_branch(session)) {
    plot = campbell_plot(session.mechanism(), of.drive, campbell.diagram.found->result, *branch, speeds,
                         of.orders, drawn.hertz);
    drawn.critical =
        driven_joint(session.mechanism(), of.drive).empty()
            ? ""
            : critical_words(campbell.diagram.found->result, *branch, shown_unit(unit, session.units));
    const ShownUnit shown_as = shown_unit(unit, session.units);
    drawn.without_modes = left_out(
        campbell.diagram.found->result.response.branches[*branch],
        [&](double speed) { return short_text(shown_as.shown(speed), 6); }, shown_as.text);
  } else {
    plot.x = {.label = {}, .unit = unit, .range = speeds, .room = 0};
    plot.y = {.label = "frequency", .unit = drawn.hertz ? "Hz" : "rad/s"};
    drawn.critical.clear();
    drawn.without_modes.clear();
  }
  plot.x.label = parameter_phrase(of.drive);
  if (converged(session)) {
    const double speed = get_parameter(session.mechanism(), of.drive);
    plot.references.push_back({.axis = 0, .at = speed, .label = "now", .color = plot_color::blue});
    if (const VibrationMode* mode = moving_mode(session);
        mode && modes_are_current(session) && mode->oscillates())
      plot.marker = PlotMarker{speed * shown_unit(unit, session.units).factor,
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
