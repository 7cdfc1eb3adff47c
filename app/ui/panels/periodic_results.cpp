// What a periodic motion runs through in a period: the one in the steady state's place where a drive makes
// the balance turn, and the limit cycle beside a steady state that hunts.
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <utility>

namespace flyball {

namespace {

constexpr int shown_digits = 6; // of ends, which are looked at rather than copied

struct RangeWords {
  std::string prefix; // of the widgets' names
  std::string name;   // of the widget
  std::string title, help;
  std::string less;       // what the numbers leave out, "beside its even -1 turns a period"
  bool amplitude = false; // is told, too
};

// What is nothing but rounding is told as zero.
std::string end_text(double value, const PeriodicRange& of, const ShownUnit& unit) {
  return short_text(std::abs(value) <= of.error ? 0 : unit.shown(value), shown_digits);
}

void range_row(Session& session, Ui& ui, const RangeWords& words, const PeriodicRange& range,
               const ShownUnit& unit) {
  const auto& [prefix, name, title, help, less, amplitude] = words;
  const NumberStyle& numbers = session.options.numbers;
  if (!std::isfinite(range.mean))
    return row(ui, title, "-", "", "It is not defined throughout the period, or does not come back.");
  const double error = std::isfinite(range.error) ? range.error : 1e-6 * std::abs(range.most - range.least);
  const std::string about =
      (help.empty() ? "" : help + "\n") + "Mean over a period; below it the ends between which it moves.\n" +
      (std::isfinite(range.error)
           ? "± " + magnitude_text(std::max(error * unit.factor, numbers.noise), numbers) + " " + unit.text
           : std::string("Its error is not known."));
  row(ui, title, value_text(unit.shown(range.mean), std::max(error, numbers.noise) * unit.factor, numbers),
      unit.text.c_str(), about.c_str());
  note_widget(ui.widgets, prefix + "/" + name);
  if (!less.empty()) {
    paragraph(less, colors_of(ui).dim);
    note_widget(ui.widgets, prefix + "/" + name + "/less");
  }
  right_digits(
      ui, end_text(range.least, range, unit) + " … " + end_text(range.most, range, unit) + " " + unit.text,
      colors_of(ui).dim);
  ImGui::Dummy({0, 0});
  if (!amplitude) return;
  const std::string within =
      std::isfinite(range.error) ? " ± " + magnitude_text(range.error * unit.factor, numbers) : "";
  right_digits(ui,
               "amplitude " + short_text(unit.factor * (range.most - range.least) / 2, shown_digits) +
                   within + " " + unit.text,
               colors_of(ui).dim);
  ImGui::Dummy({0, 0});
}

// Whether the drive gives a torque, of which a part is its load's.
bool by_torque(const Mechanism& m, const PeriodicTorque& t) {
  const int joint = joint_index(m, t.joint);
  if (joint < 0) return false;
  const auto& coordinates = m.joints[static_cast<std::size_t>(joint)].coordinates;
  const auto i = static_cast<std::size_t>(t.index);
  return i < coordinates.size() && coordinates[i].drive && coordinates[i].drive->torque;
}

std::string advance_words(const PeriodicCoordinate& c, const ShownUnit& unit) {
  if (!c.goes_on()) return "";
  const std::string turns = short_text(c.advance / (2 * std::numbers::pi), shown_digits);
  return "beside its even " +
         (c.angle ? turns + (turns == "1" || turns == "-1" ? " turn" : " turns")
                  : short_text(unit.shown(c.advance), shown_digits) + " " + unit.text) +
         " a period";
}

std::string advance_help(const PeriodicCoordinate& c, const ShownUnit& unit) {
  if (!c.goes_on()) return "";
  return "It goes on by " + short_text(unit.factor * c.advance, shown_digits) + " " + unit.text +
         " a period, and counts less its even share of that.";
}

// Of what is no more than rounding there are no rows.
bool told(const PeriodicVector& vector) {
  const PeriodicRange& size = vector.size;
  return !std::isfinite(size.mean) || !std::isfinite(size.error) || size.most > size.error;
}

// What joints, bearings and gears bear: sizes, with the ends of each component over them.
void load_rows(Session& session, Ui& ui, const PeriodicState& state, const std::string& prefix) {
  const auto vector_rows = [&](const PeriodicReaction& load, const PeriodicVector& vector, const char* unit,
                               const char* what) {
    if (!told(vector)) return;
    const ShownUnit shown = shown_unit(unit, session.units);
    std::string help = "Its size; along the world's axes:";
    for (std::size_t c = 0; c < 3; ++c) {
      const PeriodicRange& along = vector.component[c];
      help += std::string("\n") + (vector.open[c] ? "≈ " : "") + "xyz"[c] + "  " +
              end_text(along.least, along, shown) + " … " + end_text(along.most, along, shown) + " " +
              shown.text + ", mean " + end_text(along.mean, along, shown);
    }
    if (vector.nonunique())
      help += "\nThe loops hold more than they need; of many possible ones the smallest.";
    const std::string title = load.name + what;
    range_row(session, ui, {prefix, title, (vector.nonunique() ? "≈ " : "") + title, help, "", false},
              vector.size, shown);
    if (vector.unique_size)
      range_row(session, ui,
                {prefix, title + ", unique part", title + ", unique part",
                 "Of the components that the loops do not leave open.", "", false},
                *vector.unique_size, shown);
  };
  for (const auto list : {&PeriodicState::reactions, &PeriodicState::bearings})
    for (const PeriodicReaction& load : state.*list) {
      vector_rows(load, load.force, "N", ", force");
      vector_rows(load, load.torque, "N m", ", torque");
    }
  for (const PeriodicGear& g : state.gears)
    for (const bool second : {false, true}) {
      const std::string title = g.joint + (second ? ", on its second joint" : ", on its first joint");
      range_row(
          session, ui,
          {prefix, title, (g.nonunique ? "≈ " : "") + title,
           "The gear on the joint's child, along the joint's coordinate; part of its reaction.", "", false},
          second ? g.b : g.a, shown_unit((second ? g.angle_b : g.angle_a) ? "N m" : "N", session.units));
    }
}

// What springs, dampers and stops do.
void period_spring_rows(Session& session, Ui& ui, const PeriodicState& state, const std::string& prefix) {
  for (const PeriodicSpring& s : state.springs)
    for (const auto& [words, part] :
         std::initializer_list<std::pair<const char*, const std::optional<PeriodicRange>&>>{
             {", spring", s.spring}, {", damper", s.damper}, {", stop", s.stop}, {", sum", s.sum}})
      if (part)
        range_row(session, ui,
                  {prefix, coordinate_label(s) + words,
                   (s.between_points ? s.joint : coordinate_words(s)) + words,
                   s.between_points ? "Tension is positive."
                                    : "On the joint's child, positive along the joint's coordinate.",
                   "", false},
                  *part, shown_unit(s.angle ? "N m" : "N", session.units));
}

// Names of widgets begin with `prefix`.
void motion_rows(Session& session, Ui& ui, const PeriodicState& state, const std::string& prefix,
                 ResultSections& open) {
  const bool own = state.drive_periods == 0;
  const double error = own ? state.period_error : 1e-7 * state.period;
  row(ui, "Period", value_text(state.period, std::max(error, 1e-12 * state.period), {8, 1e-16, false}), "s",
      own ? ("Its own: nothing times it.\n± " + short_text(state.period_error, 2) + " s").c_str()
      : state.drive_periods == 1
          ? "That of the drives."
          : (std::to_string(state.drive_periods) + " times that of the drives.").c_str());
  const auto range = [&](const std::string& name, const std::string& title, const PeriodicRange& of,
                         const ShownUnit& unit, const std::string& help = {}, const std::string& less = {}) {
    range_row(session, ui, {prefix, name, title, help, less, own}, of, unit);
  };
  for (const PeriodicCoordinate& c : state.coordinates) {
    const ShownUnit unit = shown_unit(c.angle ? "rad" : "m", session.units);
    const std::string name = coordinate_label(c), title = coordinate_words(c);
    range(name, title, c.range, unit, advance_help(c, unit), advance_words(c, unit));
    if (c.goes_on())
      range("speed of " + name, speed_words(title), c.rate,
            shown_unit(c.angle ? "rad/s" : "m/s", session.units));
  }
  for (const PeriodicMeasure& m : state.measures)
    range(m.name, m.name, m.range, shown_unit(m.unit, session.units));
  for (const PeriodicTorque& t : state.drive_torques) {
    const std::string less = by_torque(session.mechanism(), t) ? " less load" : "";
    range("Drive of " + coordinate_label(t) + less, "Drive of " + coordinate_words(t) + less, t.range,
          shown_unit(t.angle ? "N m" : "N", session.units),
          t.nonunique ? "The loops share it among several drives: the smallest that do it." : "");
    range("Power of " + coordinate_label(t), "Power of " + coordinate_words(t), t.power,
          shown_unit("W", session.units));
  }
  if (session.options.numbers.run_times)
    row(ui, "Time to find it", duration_text(state.run_time_s, session.options.numbers), "",
        "Of the search for this motion.");
  if (text_button(ui, prefix + "/motion", "Show in the motion's plots")) show_periodic_motion(session, state);
  help_on_hover("The motion begins in this one, at the drawn phase, and lasts for two periods.");
  if (!state.springs.empty() && section(ui, prefix + "/springs", "Springs over a period", open.springs))
    period_spring_rows(session, ui, state, prefix);
  if (state.reactions.empty() && state.bearings.empty()) return;
  if (section(ui, prefix + "/reactions", "Reactions over a period", open.reactions))
    load_rows(session, ui, state, prefix);
}

} // namespace

void periodic_results(Session& session, Ui& ui, ResultSections& open) {
  const PeriodicState* state = periodic_motion(session);
  if (!state) return;
  heading(ui, "Over a period");
  motion_rows(session, ui, *state, "results/periodic", open);
}

void cycle_offer(Session& session, Ui& ui) {
  if (!may_cycle(session)) return;
  const auto& search = session.study.periodic.cycle;
  const bool wanted = session.study.periodic.cycle_wanted;
  if (check_row(
          ui, "results/cycle", "Find the limit cycle", wanted,
          (std::string(hunts(session) ? "Swings about this state grow" : "Torques drive it") +
           ": looks for the motion, with a period of its own, that it comes to, and follows it as numbers "
           "change.")
              .c_str()))
    find_cycle(session, !wanted);
  const PeriodicState* state = limit_cycle(session);
  if (search.running()) {
    task_bar(ui, "results/cycle/running", search.progress(), search.seconds());
    if (text_button(ui, "results/cycle/cancel", "Cancel")) find_cycle(session, false);
  }
  if (!state) return;
  const UiColors& colors = colors_of(ui);
  paragraph(state->message, state->status == PeriodicStatus::found ? colors.dim : colors.warn);
  note_widget(ui.widgets, "results/cycle/message");
}

void cycle_results(Session& session, Ui& ui, ResultSections& open) {
  const PeriodicState* state = limit_cycle(session);
  if (!state || state->status != PeriodicStatus::found) return;
  heading(ui, state->drive_periods == 0 ? "Limit cycle, over a period" : "Periodic motion, over a period");
  motion_rows(session, ui, *state, "results/cycle", open);
  if (!state->floquet.multipliers.empty()) {
    heading(ui, "Its Floquet multipliers");
    floquet_rows(ui, state->floquet);
  }
}

} // namespace flyball
