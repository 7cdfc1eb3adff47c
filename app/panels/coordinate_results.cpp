// Where everything settles: each coordinate in the units of the screen and in SI.
#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"
#include "engine/mechanism/address.hpp"

#include <numbers>

namespace flyball {

namespace {

constexpr double degrees = 180 / std::numbers::pi, millimetres = 1000;

std::string name_of(const CoordinateSolution& c) {
  return c.count > 1 ? c.joint + "." + std::to_string(c.index) : c.joint;
}

void free_coordinate(App& app, const CoordinateSolution& c) {
  const NumberStyle& numbers = app.options.numbers;
  const UiColors& colors = colors_of(app);
  const double factor = c.angle ? degrees : millimetres;
  const char* si = c.angle ? "rad" : "m";
  row(app, name_of(c), value_text(c.value * factor, c.error * factor, numbers), c.angle ? "°" : "mm");
  note_widget(app.widgets, "results/" + name_of(c));
  std::string second = value_text(c.value, c.error, numbers) + " " + si;
  if (c.error > 0) second += "  ± " + magnitude_text(c.error, numbers) + " " + si;
  right_text(app, second, colors.dim, true);
}

} // namespace

void coordinate_results(App& app) {
  bool any = false;
  for (const CoordinateSolution& c : app.answer.solution.coordinates) {
    if (c.driven) continue;
    if (!any) heading(app, "Where it settles");
    any = true;
    free_coordinate(app, c);
  }
}

} // namespace flyball
