#include "app/ui/tools/tools_hand.hpp"

#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// The tool is chosen, or Alt makes a hand of one that selects.
bool is_hand(const App& app, const ViewInput& input) {
  const Tool tool = app.tool.tool;
  return tool == Tool::pull || (input.alt && !places(tool) && tool != Tool::box);
}

bool holds(const App& app) {
  return app.tool.assembly || app.tool.reach || (app.tool.pull && !app.tool.pull->released);
}

} // namespace

void ask_held(Session& session, std::shared_ptr<const Mechanism> mechanism,
              std::vector<std::pair<std::string, double>> start, std::optional<BodyPoint> grip,
              bool nearest) {
  session.awaited = session.asked = session.live.ask({.mechanism = std::move(mechanism),
                                                      .time = session.playback.time,
                                                      .another = false,
                                                      .warm = true,
                                                      .nearest = nearest,
                                                      .start = std::move(start),
                                                      .points = told_points(session),
                                                      .grip = std::move(grip)});
}

std::optional<HandHit> body_under_cursor(App& app, const ViewInput& input) {
  const SceneList& scene = shown_scene(app)->solid;
  // Bodies come first in the list. A joint's sign in front of one does not hide it.
  const auto last = std::ranges::find_if_not(scene.instances,
                                             [](const Instance& i) { return i.part.kind == PartKind::body; });
  const auto hit = pick(std::span(scene.instances.begin(), last), input.ray(), 4 * input.point);
  if (!hit) return {};
  return HandHit{part_of(*shown_mechanism(app), hit->part).name, hit->point};
}

std::optional<Vec3> on_plane(const HandPlane& plane, const Ray& ray) {
  constexpr double along = 0.02; // of the sine of the angle
  const double across = ray.direction.dot(plane.normal);
  if (std::abs(across) < along) return {};
  const double way = (plane.through - ray.origin).dot(plane.normal) / across;
  if (!(way > 0)) return {};
  return ray.origin + way * ray.direction;
}

bool use_hand(App& app, const ViewInput& input) {
  ToolState& tool = app.tool;
  follow_pull(app);
  follow_reach(app);
  if (tool.assembly && app.mode != Mode::build) let_go_assembly(app, true);
  if (tool.pull && app.mode != Mode::explore) let_go_pull(app, true);
  if (tool.reach && app.mode != Mode::explore) let_go_reach(app, true);
  if (!holds(app)) {
    if (!is_hand(app, input) || tool.grab || tool.frame || tool.spent || !input.hovered) return false;
    if (!input.pressed) {
      if (!input.active && app.view.hovered.kind == PartKind::body)
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
      return false;
    }
    const auto hit = body_under_cursor(app, input);
    if (!hit) return false;
    if (app.mode == Mode::build)
      take_assembly(app, input, *hit);
    else if (input.shift)
      take_reach(app, input, *hit);
    else
      take_pull(app, input, *hit);
    return holds(app);
  }
  ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
    step_back(app);
    return true;
  }
  if (tool.assembly)
    hold_assembly(app, input);
  else if (tool.reach)
    hold_reach(app, input);
  else
    hold_pull(app, input);
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    let_go_hand(app, true);
    tool.spent = input.moved; // letting go is no click, but a click selects
    return input.moved;
  }
  return true;
}

bool let_go_hand(App& app, bool keep) {
  if (!holds(app)) return false;
  if (app.tool.assembly)
    let_go_assembly(app, keep);
  else if (app.tool.reach)
    let_go_reach(app, keep);
  else
    let_go_pull(app, keep);
  return true;
}

std::string hand_hint(const App& app) {
  if (app.tool.assembly) return "Its joints lead the way. Esc takes it back.";
  if (app.tool.reach) return "Sliders follow. Esc takes it back.";
  if (holds(app)) return "The wheel makes the spring stiffer or softer. Esc takes it back.";
  return "";
}

} // namespace flyball
