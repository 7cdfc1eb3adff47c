// How the selected bodies move in the steady state: their mass centres, and a point of each that a person has
// typed.
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

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

// `name` begins the widgets' and `of` ends them.
void motion_rows(App& app, const PointMotion& motion, const std::string& name, const std::string& of) {
  const char* at_phase = "x, y, z in world axes, at the drawn phase of the drives.";
  const ShownUnit length = coordinate_unit(false, app.units), speed = rate_unit(false, app.units);
  row(app, "Position", components_text(motion.position, length.factor), length.text.c_str(), at_phase);
  note_widget(app.widgets, name + "position/" + of);
  row(app, "Velocity", components_text(motion.velocity, speed.factor), speed.text.c_str(), at_phase);
  row(app, "Speed", size_text(motion.velocity, speed.factor), speed.text.c_str());
  note_widget(app.widgets, name + "speed/" + of);
  row(app, "Acceleration", components_text(motion.acceleration, 1), "m/s²", at_phase);
  row(app, "Magnitude", size_text(motion.acceleration, 1), "m/s²");
  note_widget(app.widgets, name + "acceleration/" + of);
}

// The tick, the three fields, and how the point moves.
void point_results(App& app, const Body& body) {
  const auto told = app.points.find(body.name);
  const bool on = told != app.points.end();
  if (check_row(app, "results/point/on", "Another point of it", on,
                "Tells how one more point fixed in the body moves, here and in the plots of the motion."))
    later(app, [&app, name = body.name, on, centre = body.position] {
      tell_point(app, name, on ? std::optional<Vec3>() : centre);
    });
  if (!on) return;
  vector_rows(app, "As drawn",
              {.name = "results/point",
               .value = told->second,
               .unit = "m",
               .help = "Where the point is in the drawn pose, in the world; it is fixed in the body.",
               .set = [&app, name = body.name](int axis, double value) {
                 const auto known = app.points.find(name);
                 if (known == app.points.end()) return;
                 Vec3 at = known->second;
                 at[axis] = value;
                 tell_point(app, name, at);
               }});
  const std::vector<PointSolution>& points = app.answer.solution.points;
  const auto found = std::ranges::find(points, BodyPoint{body.name, told->second}, &PointSolution::point);
  if (found != points.end()) motion_rows(app, found->motion, "results/point/", body.name);
}

// Above and below what is told of one body, so that it is not read as part of its neighbours.
void line_across(Ui& ui) {
  const float s = ui.scale, width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy({width, 5 * s});
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRectFilled({from.x, to.y - std::max(1.f, std::round(s))}, to,
                                            packed(colors_of(ui).border));
}

} // namespace

void body_results(App& app) {
  const Solution& solution = app.answer.solution;
  if (app.mode != Mode::explore || !app.answer.mechanism) return;
  const std::vector<Body>& bodies = app.answer.mechanism->bodies;
  const bool known = solution.centres.size() == bodies.size(); // else the point counts in the motion alone
  bool any = false;
  for (const std::string& name : app.selection().names(PartKind::body)) {
    const int b = body_index(*app.answer.mechanism, name);
    if (b < 0) continue;
    const auto i = static_cast<std::size_t>(b);
    any = true;
    ImGui::PushID(name.c_str());
    line_across(app);
    heading(app, ((known ? "Mass centre of " : "Motion of ") + name).c_str());
    if (known) motion_rows(app, solution.centres[i], "results/", name);
    point_results(app, bodies[i]);
    ImGui::PopID();
  }
  if (any) line_across(app);
}

} // namespace flyball
