// Where everything settles: each coordinate in the units of the screen, in SI where these are others, and its
// error.
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/goal_handle.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {

namespace {

// With more coordinates than this each takes one line, and the rest appears over it.
constexpr int spacious = 8;
// With more than this the first ones are told until all are asked for, so that what comes below is in reach.
constexpr std::ptrdiff_t unfolded = 30, told_at_first = 12;

void free_coordinate(Session& session, Ui& ui, const CoordinateSolution& c, bool compact) {
  const auto [name, value, error, si] = *found_number(c);
  const NumberStyle& numbers = session.options.numbers;
  const UiColors& colors = colors_of(ui);
  const ShownUnit unit = shown_unit(si, session.units);
  row(ui, found_words(c), value_text(unit.shown(value), error * unit.factor, numbers), unit.text.c_str(),
      c.dependent ? "The joint closes a loop: this follows from the other coordinates." : nullptr);
  const std::string in_si = " " + std::string(si), widget = "results/" + coordinate_label(c);
  std::string second; // the same in SI, where that is another unit, and its error
  if (unit.text != si) second = value_text(value, error, numbers) + in_si;
  if (error > 0)
    second +=
        (second.empty() ? "± " : "  ± ") + magnitude_text(std::max(error, numbers.noise), numbers) + in_si;
  if (c.dependent) {
    note_widget(ui.widgets, widget);
    if (compact) help_on_hover(second.c_str());
  } else {
    goal_handle(session, ui,
                {.name = widget,
                 .wanted = name,
                 .value = value,
                 .unit = std::string(si),
                 .help = c.speed   ? "The steady speed: there the drive's torque, less its load, is what "
                                     "turning takes."
                         : compact ? second
                                   : ""});
  }
  if (compact || second.empty()) return;
  right_digits(ui, second, colors.dim);
  note_widget(ui.widgets, widget + "/error");
  ImGui::Dummy({0, 0});
}

} // namespace

void coordinate_results(Session& session, Ui& ui, ResultSections& open) {
  const auto& all = session.answer.solution.coordinates;
  const auto free = std::ranges::count_if(all, is_found);
  if (free == 0) return;
  heading(ui, session.answer.solution.stable == false ? "Where it balances" : "Where it settles");
  if (free <= spacious) {
    for (const CoordinateSolution& c : all)
      if (is_found(c)) free_coordinate(session, ui, c, false);
    return;
  }
  std::ptrdiff_t told = free;
  if (free > unfolded) {
    const std::string text = open.coordinates ? "The first " + std::to_string(told_at_first) + " alone"
                                              : "All " + std::to_string(free) + " coordinates";
    if (text_button(ui, "results/coordinates/all", text.c_str())) open.coordinates = !open.coordinates;
    if (!open.coordinates) told = told_at_first;
  }
  // Of thousands only those that are in sight; the driven ones among them, which are few, take no line.
  auto next = all.begin();
  std::ptrdiff_t passed = 0; // free ones before `next`
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(told));
  while (clipper.Step())
    for (; next != all.end() && passed < clipper.DisplayEnd; ++next) {
      if (!is_found(*next)) continue;
      if (passed++ >= clipper.DisplayStart) free_coordinate(session, ui, *next, true);
    }
}

} // namespace flyball
