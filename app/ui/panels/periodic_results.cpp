// Where a drive makes the balance turn: what the motion in the steady state's place runs through in a period.
#include "app/session/units.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr int digits = 6; // of ends, which are looked at rather than copied

// `less`: what the numbers leave out, "less -1 turns a period".
void range_row(Session& session, Ui& ui, const std::string& name, const PeriodicRange& range,
               const ShownUnit& unit, const std::string& help = {}, const std::string& less = {}) {
  const NumberStyle& numbers = session.options.numbers;
  if (!std::isfinite(range.mean))
    return row(ui, name, "-", "", "It is not defined throughout the period, or does not come back.");
  const double error = std::isfinite(range.error) ? range.error : 1e-6 * std::abs(range.most - range.least);
  const std::string about =
      (help.empty() ? "" : help + "\n") + "Mean over a period; below it the ends between which it moves.\n" +
      (std::isfinite(range.error)
           ? "± " + magnitude_text(std::max(error * unit.factor, numbers.noise), numbers) + " " + unit.text
           : std::string("Its error is not known."));
  row(ui, name, value_text(unit.shown(range.mean), std::max(error, numbers.noise) * unit.factor, numbers),
      unit.text.c_str(), about.c_str());
  note_widget(ui.widgets, "results/periodic/" + name);
  if (!less.empty()) {
    paragraph(less, colors_of(ui).dim);
    note_widget(ui.widgets, "results/periodic/" + name + "/less");
  }
  right_digits(ui,
               short_text(unit.shown(range.least), digits) + " … " +
                   short_text(unit.shown(range.most), digits) + " " + unit.text,
               colors_of(ui).dim);
  ImGui::Dummy({0, 0});
}

std::string advance_words(const PeriodicCoordinate& c, const ShownUnit& unit) {
  if (!c.goes_on()) return "";
  return "less " +
         (c.angle ? short_text(c.advance / (2 * std::numbers::pi), digits) + " turns"
                  : short_text(unit.shown(c.advance), digits) + " " + unit.text) +
         " a period";
}

std::string advance_help(const PeriodicCoordinate& c, const ShownUnit& unit) {
  if (!c.goes_on()) return "";
  return "It goes on by " + short_text(unit.factor * c.advance, digits) + " " + unit.text +
         " a period, and counts less its even share of that.";
}

} // namespace

void periodic_results(Session& session, Ui& ui) {
  const PeriodicState* state = periodic_motion(session);
  if (!state) return;
  heading(ui, "Over a period");
  row(ui, "Period", value_text(state->period, 1e-7 * state->period, {8, 1e-16, false}), "s",
      state->drive_periods == 1
          ? "That of the drives."
          : (std::to_string(state->drive_periods) + " times that of the drives.").c_str());
  for (const PeriodicCoordinate& c : state->coordinates) {
    const ShownUnit unit = shown_unit(c.angle ? "rad" : "m", session.units);
    range_row(session, ui, coordinate_label(c), c.range, unit, advance_help(c, unit), advance_words(c, unit));
  }
  for (const PeriodicMeasure& m : state->measures)
    range_row(session, ui, m.name, m.range, shown_unit(m.unit, session.units));
  for (const PeriodicTorque& t : state->drive_torques)
    range_row(session, ui, "Drive of " + coordinate_label(t), t.range,
              shown_unit(t.angle ? "N m" : "N", session.units));
  if (session.options.numbers.run_times)
    row(ui, "Run time", duration_text(state->run_time_s, session.options.numbers), "");
  if (text_button(ui, "results/periodic/motion", "Show in the motion's plots")) show_periodic_motion(session);
  help_on_hover("The motion begins in this one, at the drawn phase.");
}

} // namespace flyball
