// How the mass centres of the selected bodies move in the steady state.
#include "app/panels/panels.hpp"
#include "app/panels/units.hpp"
#include "app/panels/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

// Components that are rounding beside the largest are zero.
std::string components_text(const Vec3& v, double factor) {
  const double size = v.lpNorm<Eigen::Infinity>();
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i ? "  " : "") + (std::abs(v[i]) <= 1e-12 * size ? "0" : short_text(v[i] * factor, 6));
  return text;
}

std::string size_text(const Vec3& v, double factor) {
  return short_text(v.norm() * factor, 6);
}

} // namespace

void body_results(App& app) {
  const Solution& solution = app.answer.solution;
  const std::vector<Body>& bodies = app.answer.mechanism.bodies;
  if (app.mode != Mode::explore || solution.centres.size() != bodies.size()) return;
  const char* at_phase = "x, y, z in world axes, at the drawn phase of the drives.";
  for (const std::string& name : app.selection().names(PartKind::body)) {
    const int b = body_index(app.answer.mechanism, name);
    if (b < 0) continue;
    const PointMotion& centre = solution.centres[static_cast<std::size_t>(b)];
    const ShownUnit length = coordinate_unit(false, app.units), speed = rate_unit(false, app.units);
    heading(app, ("Mass centre of " + name).c_str());
    row(app, "Position", components_text(centre.position, length.factor), length.text.c_str(), at_phase);
    note_widget(app.widgets, "results/position/" + name);
    row(app, "Velocity", components_text(centre.velocity, speed.factor), speed.text.c_str(), at_phase);
    row(app, "Speed", size_text(centre.velocity, speed.factor), speed.text.c_str());
    note_widget(app.widgets, "results/speed/" + name);
    row(app, "Acceleration", components_text(centre.acceleration, 1), "m/s²", at_phase);
    row(app, "Its size", size_text(centre.acceleration, 1), "m/s²");
    note_widget(app.widgets, "results/acceleration/" + name);
  }
}

} // namespace flyball
