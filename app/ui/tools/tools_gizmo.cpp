// Moving and turning the selected parts by handles in the view. A drag is one step of the history, made of
// the state it began with at every movement.
#include "app/document/settle_formulas.hpp"
#include "app/session/quantity.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/gizmo_drawing.hpp"
#include "app/ui/tools/joints_along.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/viewport/snapping.hpp"
#include "engine/mechanism/formulas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace flyball {

namespace {

// The whole of the selection where it is one point.
std::optional<PointId> only_point(const Mechanism& mechanism, const Selection& selection) {
  if (selection.parts.size() != 1) return std::nullopt;
  const PointId first{selection.parts[0], 0};
  if (!point_position(mechanism, first) || point_position(mechanism, {first.part, 1})) return std::nullopt;
  return first;
}

// The one point that is held.
std::optional<PointId> point_of(const Mechanism& mechanism, const Grab& grab) {
  return grab.point ? grab.point : only_point(mechanism, grab.selection);
}

// Of what then stands at a named point; empty: it does not.
std::string address_of(const Mechanism& mechanism, const Grab& grab) {
  const auto point = point_of(mechanism, grab);
  return point ? point_address(mechanism, *point) : "";
}

void move_grabbed(Mechanism& mechanism, const Grab& grab, const Vec3& target, OuterJoints joints) {
  if (const int named = point_index(mechanism, grab.named); named >= 0)
    mechanism.points[static_cast<std::size_t>(named)].at = target;
  else if (const auto point = point_of(mechanism, grab))
    set_point(mechanism, *point, target, joints);
  else
    move_parts(mechanism, grab.selection, target - grab.centre, joints);
}

// The other end of what has two and is dragged by one of them.
std::optional<Vec3> other_end(const Grab& grab) {
  if (!grab.point) return std::nullopt;
  return point_position(*grab.before, {grab.point->part, 1 - grab.point->end});
}

// Points to snap to: those that stay where they are when the grabbed ones go far away.
std::vector<SnapPoint> targets_of(const Grab& grab) {
  Mechanism moved = *grab.before;
  move_grabbed(moved, grab, grab.centre + Vec3(1.2345e3, 2.3456e3, 3.4567e3), OuterJoints::follow);
  try {
    settle_formulas(*grab.before, moved); // what the same point or parameter gives moves along
  } catch (const SceneError&) {           // it cannot be moved so far
  }
  std::vector<SnapPoint> stayed = snap_points(moved), before = snap_points(*grab.before);
  const auto place = [](const SnapPoint& p) { return std::array{p.point.x(), p.point.y(), p.point.z()}; };
  std::ranges::sort(before, {}, place);
  std::erase_if(stayed,
                [&](const SnapPoint& p) { return !std::ranges::binary_search(before, place(p), {}, place); });
  return stayed;
}

std::string step_name(const Grab& grab) {
  const std::vector<Part>& parts = grab.selection.parts;
  const std::string what = parts.size() == 1 ? parts[0].name : std::to_string(parts.size()) + " parts";
  if (!grab.named.empty()) return "Move " + grab.named;
  if (grab.point) return "Move end of " + what;
  return (is_ring(grab.handle) ? "Rotate " : "Move ") + what;
}

void take_hold(const Session& session, ToolState& tool, const ViewInput& input, const Gizmo& gizmo,
               Handle handle, std::optional<PointId> point) {
  Grab grab;
  grab.handle = handle;
  grab.point = std::move(point);
  if (const NamedPoint* named = selected_point(session, tool)) grab.named = named->name;
  grab.normal = gizmo.normal;
  grab.before = session.document.steps()[session.document.position()].mechanism;
  grab.selection = session.selection();
  grab.centre = gizmo.centre;
  grab.from = input.ray();
  grab.gesture = session.gesture;
  grab.name = step_name(grab);
  if (!is_ring(handle)) grab.targets = targets_of(grab);
  tool.grab = std::move(grab);
}

// An edit of the drag, whatever was pressed meanwhile.
void edit_grabbed(Session& session, const ToolState& tool, const std::function<void(Mechanism&)>& change) {
  const Grab& grab = *tool.grab;
  const std::uint64_t gesture = std::exchange(session.gesture, grab.gesture);
  edit(session, grab.name, [&](Mechanism& mechanism, Selection& selection) {
    mechanism = *grab.before;
    selection = grab.selection;
    change(mechanism);
    settle_formulas(*grab.before, mechanism); // not by what an earlier movement has made of it
  });
  session.gesture = gesture;
}

void turn_by_gizmo(Session& session, ToolState& tool, const ViewInput& input, const Gizmo& gizmo) {
  Grab& grab = *tool.grab;
  const auto turned_by = turned(gizmo, grab.handle, grab.from, input.ray());
  if (turned_by) grab.swept += std::remainder(*turned_by - grab.swept, 2 * std::numbers::pi);
  double angle = snaps(tool, input) ? round_angle(grab.swept) : grab.swept;
  if (const Quantity typed = parse_quantity(grab.typed, "rad", shown_unit("rad", session.units).text);
      !grab.typed.empty() && typed)
    angle = typed.value;
  if (angle == grab.angle && grab.shift == input.shift) return;
  grab.angle = angle;
  grab.shift = input.shift;
  const Quat rotation(Eigen::AngleAxisd(angle, Vec3::Unit(axis_of(grab.handle))));
  edit_grabbed(session, tool, [&](Mechanism& mechanism) {
    if (angle != 0)
      rotate_parts(mechanism, grab.selection, grab.centre, rotation, joints_of_moved(tool, input.shift));
  });
  tell_joints(session, tool, grab.selection, input.shift);
}

void move(Session& session, ToolState& tool, const ViewInput& input, const Gizmo& gizmo) {
  Grab& grab = *tool.grab;
  const auto by = dragged(gizmo, grab.handle, grab.from, input.ray());
  if (!by) return;
  const std::array<bool, 3> free = free_coordinates(grab.handle, grab.normal);
  Vec3 target = grab.centre + *by;
  grab.what.clear();
  grab.stands.clear();
  const Quantity typed = parse_quantity(grab.typed, "m", shown_unit("m", session.units).text);
  const bool arrow = std::ranges::count(free, true) == 1;
  // Along the arrow; else as far from the other end, or from where it was, on the line to where the hand is.
  const Vec3 origin = other_end(grab).value_or(grab.centre);
  const Vec3 along = arrow ? Vec3::Unit(axis_of(grab.handle)) : Vec3((target - origin).stableNormalized());
  if (!grab.typed.empty() && typed && along.norm() > 0) {
    target = origin + typed.value * along;
  } else if (input.moved && snaps(tool, input)) {
    const SnapPoint* point =
        snap_point(grab.targets, input.camera, input.size, input.cursor, snap_reach * input.point);
    target = on_grid(target, free, grid_step(input));
    if (point) {
      grab.what = point->what;
      for (int i = 0; i < 3; ++i)
        if (free[static_cast<std::size_t>(i)]) target[i] = point->point[i];
      if (target == point->point && !address_of(*grab.before, grab).empty()) grab.stands = point->named;
    }
  } else if (!input.moved) {
    return; // a press does not move anything
  }
  const Vec3 moved = target - grab.centre;
  if (moved == grab.by && grab.shift == input.shift) return;
  grab.by = moved;
  grab.shift = input.shift;
  edit_grabbed(session, tool, [&](Mechanism& mechanism) {
    move_grabbed(mechanism, grab, target, joints_of_moved(tool, input.shift));
    stand_at(mechanism, address_of(mechanism, grab), grab.stands);
  });
  tell_joints(session, tool, grab.selection, input.shift);
}

void hold(const ViewContext& context, const ViewInput& input, const Gizmo& gizmo) {
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
    step_back(context.session, context.tool);
    return;
  }
  if (is_ring(context.tool.grab->handle))
    turn_by_gizmo(context.session, context.tool, input, gizmo);
  else
    move(context.session, context.tool, input, gizmo);
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    let_go(context.session, context.tool, true);
    // Letting go is no click; but a click on a handle means the part behind it, if there is any.
    context.tool.spent = input.moved || !part_under_cursor(context, input);
  }
}

void draw_ends(const Session& session, Ui& ui, ToolState& tool, const ViewInput& input) {
  tool.hovered_point.reset();
  const std::vector<Vec3>& ends = cached_ends(session, tool);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto at = input.on_screen(ends[i]);
    if (!at) continue;
    const PointId end{session.selection().parts[0], static_cast<int>(i)};
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float reach = 8 * ui.scale;
    const bool held = tool.grab && tool.grab->point == end;
    const bool lit = held || (!tool.grab && input.hovered && (!input.active || input.pressed) &&
                              std::max(std::abs(mouse.x - at->x), std::abs(mouse.y - at->y)) < reach);
    if (lit) tool.hovered_point = end;
    draw_square(ui, *at, 4, lit);
    ui.widgets["gizmo/end" + std::to_string(i)] = {{at->x - reach / 2, at->y - reach / 2},
                                                   {at->x + reach / 2, at->y + reach / 2}};
  }
}

void note_handles(Ui& ui, const ViewInput& input, const std::vector<HandleShape>& shapes) {
  const float half = 3 * ui.scale;
  for (const HandleShape& shape : shapes) {
    const ImVec2 at = input.on_screen(shape.grip);
    ui.widgets["gizmo/" + std::string(handle_name(shape.handle))] = {{at.x - half, at.y - half},
                                                                     {at.x + half, at.y + half}};
  }
}

} // namespace

void let_go(Session& session, ToolState& tool, bool keep) {
  if (!keep) edit_grabbed(session, tool, [](Mechanism&) {});
  tool.grab.reset();
}

void use_gizmo(const ViewContext& context, const ViewInput& input) {
  ToolState& tool = context.tool;
  const bool wanted =
      context.session.mode == Mode::build && (tool.tool == Tool::select || tool.tool == Tool::rotate);
  const NamedPoint* named = selected_point(context.session, context.tool);
  const auto centre = !wanted ? std::nullopt
                      : named ? std::optional(named->at)
                              : cached_centre(context.session, context.tool);
  const Handle before = std::exchange(tool.hovered, Handle::none);
  if (!centre) {
    tool.hovered_point.reset();
    return;
  }
  Gizmo gizmo{tool.tool == Tool::rotate && !named ? GizmoKind::rings : GizmoKind::arrows,
              *centre,
              axis_in_view(input.camera),
              input.camera,
              input.size,
              input.point};
  if (tool.grab) {
    draw_grabbed(context.session, context.ui, context.tool, input);
    draw_ends(context.session, context.ui, context.tool, input);
    gizmo.centre = tool.grab->centre;
    gizmo.normal = tool.grab->normal;
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    hold(context, input, gizmo);
    return;
  }
  const std::vector<HandleShape> shapes = handle_shapes(gizmo);
  if (input.hovered && (!input.active || input.pressed))
    tool.hovered = handle_at(shapes, input.cursor, input.point);
  // A click on a handle neither picks nor drops anything behind it.
  if (input.active && !input.pressed && before != Handle::none) tool.hovered = before;
  if (tool.frame) tool.hovered = Handle::none;
  draw_handles(context.ui, input, shapes, tool.hovered);
  draw_ends(context.session, context.ui, context.tool, input);
  note_handles(context.ui, input, shapes);
  if (tool.hovered_point) tool.hovered = Handle::none;
  if (tool.hovered_point || tool.hovered != Handle::none) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (!input.pressed) return;
  if (tool.hovered_point) {
    gizmo.centre =
        cached_ends(context.session, context.tool)[static_cast<std::size_t>(tool.hovered_point->end)];
    take_hold(context.session, context.tool, input, gizmo, Handle::plane, tool.hovered_point);
  } else if (tool.hovered != Handle::none) {
    take_hold(context.session, context.tool, input, gizmo, tool.hovered, std::nullopt);
  }
}

} // namespace flyball
