// How the selected bodies move in the steady state: their mass centres, and a point of each that a person has
// typed.
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/panels/result_sections.hpp"
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
void motion_rows(const Session& session, Ui& ui, const PointMotion& motion, const std::string& name,
                 const std::string& of) {
  const char* at_phase = "x, y, z in world axes, at the drawn phase of the drives.";
  const ShownUnit length = coordinate_unit(false, session.units), speed = rate_unit(false, session.units);
  row(ui, "Position", components_text(motion.position, length.factor), length.text.c_str(), at_phase);
  note_widget(ui.widgets, name + "position/" + of);
  row(ui, "Velocity", components_text(motion.velocity, speed.factor), speed.text.c_str(), at_phase);
  row(ui, "Speed", size_text(motion.velocity, speed.factor), speed.text.c_str());
  note_widget(ui.widgets, name + "speed/" + of);
  row(ui, "Acceleration", components_text(motion.acceleration, 1), "m/s²", at_phase);
  row(ui, "Magnitude", size_text(motion.acceleration, 1), "m/s²");
  note_widget(ui.widgets, name + "acceleration/" + of);
}

// The tick, the three fields, and how the point moves.
void point_results(Session& session, Ui& ui, const Body& body) {
  const auto told = session.points.find(body.name);
  const bool on = told != session.points.end();
  if (check_row(ui, "results/point/on", "Another point of it", on,
                "Tells how one more point fixed in the body moves, here and in the plots of the motion."))
    later(ui, [&session, name = body.name, on, centre = body.position] {
      tell_point(session, name, on ? std::optional<Vec3>() : centre);
    });
  if (!on) return;
  vector_rows(session, ui, "As drawn",
              {.name = "results/point",
               .value = told->second,
               .unit = "m",
               .help = "Where the point is in the drawn pose, in the world; it is fixed in the body.",
               .set = [&session, name = body.name](int axis, double value) {
                 const auto known = session.points.find(name);
                 if (known == session.points.end()) return;
                 Vec3 at = known->second;
                 at[axis] = value;
                 tell_point(session, name, at);
               }});
  const std::vector<PointSolution>& points = session.answer.solution.points;
  const auto found = std::ranges::find(points, BodyPoint{body.name, told->second}, &PointSolution::point);
  if (found != points.end()) motion_rows(session, ui, found->motion, "results/point/", body.name);
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

void body_results(Session& session, Ui& ui) {
  const Solution& solution = session.answer.solution;
  if (session.mode != Mode::explore || !session.answer.mechanism) return;
  const std::vector<Body>& bodies = session.answer.mechanism->bodies;
  const bool known = solution.centres.size() == bodies.size(); // else the point counts in the motion alone
  bool any = false;
  for (const std::string& name : session.selection().names(PartKind::body)) {
    const int b = body_index(*session.answer.mechanism, name);
    if (b < 0) continue;
    const auto i = static_cast<std::size_t>(b);
    any = true;
    ImGui::PushID(name.c_str());
    line_across(ui);
    heading(ui, ((known ? "Mass centre of " : "Motion of ") + name).c_str());
    if (known) motion_rows(session, ui, solution.centres[i], "results/", name);
    point_results(session, ui, bodies[i]);
    ImGui::PopID();
  }
  if (any) line_across(ui);
}

} // namespace flyball
