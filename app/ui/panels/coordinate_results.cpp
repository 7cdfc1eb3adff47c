// Where everything settles: each coordinate in the units of the screen and in SI.
#include "app/session/units.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/goal_handle.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {

namespace {

// With more coordinates than this each takes one line, and the rest appears over it.
constexpr int spacious = 8;

void free_coordinate(App& app, const CoordinateSolution& c, bool compact) {
  const NumberStyle& numbers = app.options.numbers;
  const UiColors& colors = colors_of(app);
  const ShownUnit unit = coordinate_unit(c.angle, app.units);
  const char* si = c.angle ? "rad" : "m";
  row(app, coordinate_label(c), value_text(unit.shown(c.value), c.error * unit.factor, numbers),
      unit.text.c_str(),
      c.dependent ? "The joint closes a loop: this follows from the other coordinates." : nullptr);
  if (c.dependent)
    note_widget(app.widgets, "results/" + coordinate_label(c));
  else
    goal_handle(app, {.name = "results/" + coordinate_label(c),
                      .wanted = coordinate_label(c),
                      .value = c.value,
                      .unit = si});
  std::string second = value_text(c.value, c.error, numbers) + " " + si;
  if (c.error > 0) second += "  ± " + magnitude_text(std::max(c.error, numbers.noise), numbers) + " " + si;
  if (compact)
    help_on_hover(second.c_str());
  else {
    right_digits(app, second, colors.dim);
    ImGui::Dummy({0, 0});
  }
}

} // namespace

void coordinate_results(App& app) {
  const auto& all = app.answer.solution.coordinates;
  const auto free = std::ranges::count(all, false, &CoordinateSolution::driven);
  if (free == 0) return;
  heading(app, "Where it settles");
  if (free <= spacious) {
    for (const CoordinateSolution& c : all)
      if (!c.driven) free_coordinate(app, c, false);
    return;
  }
  // Of thousands only those that are in sight; the driven ones among them, which are few, take no line.
  auto next = all.begin();
  std::ptrdiff_t passed = 0; // free ones before `next`
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(free));
  while (clipper.Step())
    for (; next != all.end() && passed < clipper.DisplayEnd; ++next) {
      if (next->driven) continue;
      if (passed++ >= clipper.DisplayStart) free_coordinate(app, *next, true);
    }
}

} // namespace flyball
