#include "app/ui/tools/tools_hand.hpp"

#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// The tool is chosen, or Alt makes a hand of one that selects.
bool is_hand(const ToolState& state, const ViewInput& input) {
  const Tool tool = state.tool;
  return tool == Tool::pull || (input.alt && !places(tool) && tool != Tool::box);
}

bool holds(const ToolState& tool) {
  return tool.assembly || tool.reach || (tool.pull && !tool.pull->released);
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

std::optional<HandHit> body_under_cursor(const ViewContext& context, const ViewInput& input) {
  const SceneList& scene = shown_scene(context)->solid;
  // Bodies come first in the list. A joint's sign in front of one does not hide it.
  const auto last = std::ranges::find_if_not(scene.instances,
                                             [](const Instance& i) { return i.part.kind == PartKind::body; });
  const auto hit = pick(std::span(scene.instances.begin(), last), input.ray(), 4 * input.point);
  if (!hit) return {};
  return HandHit{part_of(*shown_mechanism(context.session, context.tool), hit->part).name, hit->point};
}

std::optional<Vec3> on_plane(const HandPlane& plane, const Ray& ray) {
  constexpr double along = 0.02; // of the sine of the angle
  const double across = ray.direction.dot(plane.normal);
  if (std::abs(across) < along) return {};
  const double way = (plane.through - ray.origin).dot(plane.normal) / across;
  if (!(way > 0)) return {};
  return ray.origin + way * ray.direction;
}

bool use_hand(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  follow_pull(context.session, context.tool);
  follow_reach(context.session, context.tool);
  if (tool.assembly && context.session.mode != Mode::build)
    let_go_assembly(context.session, context.tool, true);
  if (tool.pull && context.session.mode != Mode::explore) let_go_pull(context.session, context.tool, true);
  if (tool.reach && context.session.mode != Mode::explore) let_go_reach(context.session, context.tool, true);
  if (!holds(context.tool)) {
    if (!is_hand(context.tool, input) || tool.grab || tool.frame || tool.spent || !input.hovered)
      return false;
    if (!input.pressed) {
      if (!input.active && context.view.hovered.kind == PartKind::body)
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
      return false;
    }
    const auto hit = body_under_cursor(context, input);
    if (!hit) return false;
    if (context.session.mode == Mode::build)
      take_assembly(context.session, context.tool, input, *hit);
    else if (input.shift)
      take_reach(context.session, context.tool, input, *hit);
    else
      take_pull(context.session, context.tool, input, *hit);
    return holds(context.tool);
  }
  ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
    step_back(context.session, context.tool);
    return true;
  }
  if (tool.assembly)
    hold_assembly(context.session, context.ui, context.tool, input);
  else if (tool.reach)
    hold_reach(context.session, context.ui, context.tool, input);
  else
    hold_pull(context.session, context.ui, context.tool, input);
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    let_go_hand(context.session, context.tool, true);
    tool.spent = input.moved; // letting go is no click, but a click selects
    return input.moved;
  }
  return true;
}

bool let_go_hand(Session& session, ToolState& tool, bool keep) {
  if (!holds(tool)) return false;
  if (tool.assembly)
    let_go_assembly(session, tool, keep);
  else if (tool.reach)
    let_go_reach(session, tool, keep);
  else
    let_go_pull(session, tool, keep);
  return true;
}

std::string hand_hint(const ToolState& tool) {
  if (tool.assembly) return "Its joints lead the way. Esc takes it back.";
  if (tool.reach) return "Sliders follow. Esc takes it back.";
  if (holds(tool)) return "The wheel makes the spring stiffer or softer. Esc takes it back.";
  return "";
}

} // namespace flyball
