// A body of the drawn pose pulled along its joints: one step of the history, made of the state that it began
// with.
#include "app/ui/assembly_edits.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/tools/tools_hand.hpp"

#include <cmath>
#include <utility>

namespace flyball {

namespace {

constexpr double seen_across = 0.25; // sine of the least angle at which a plane is one to move on

void draw_assembly(const Ui& ui, const ToolState& tool, const ViewInput& input) {
  const AssemblyGrab& grab = *tool.assembly;
  const auto at = input.on_screen(grab.drag.position(grab.grabbed)), to = input.on_screen(grab.target);
  if (!at) return;
  // A line to the hand where it is out of reach.
  if (grab.moved && to && std::hypot(to->x - at->x, to->y - at->y) > 3 * ui.scale)
    draw_line(ui, *at, *to, palette(ui.theme).accent, 1.5f);
  draw_dot(ui, *at, 5, true);
  if (grab.moved)
    draw_tag(ui, input, input.cursor,
             grab.outcome.at_stop ? grab.grabbed.body + " at a stop" : grab.grabbed.body, "");
}

// An edit of the drag, whatever was pressed meanwhile.
void redraw_grabbed(Session& session, const ToolState& tool, const MechanismPose& pose) {
  const AssemblyGrab& grab = *tool.assembly;
  const std::uint64_t gesture = std::exchange(session.gesture, grab.gesture);
  redraw(session, grab.step, *grab.before, pose, grab.selection);
  session.gesture = gesture;
}

} // namespace

void take_assembly(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit) {
  const auto before = session.document.steps()[session.document.position()].mechanism;
  try {
    AssemblyGrab grab{.drag = AssemblyDrag(*before),
                      .grabbed = {hit.body, hit.point},
                      .plane = {.through = hit.point, .normal = input.camera.backward()},
                      .before = before,
                      .start = drawn_poses(*before),
                      .selection = session.selection(),
                      .gesture = session.gesture,
                      .step = "Pull " + hit.body};
    if (!grab.drag.assembled()) {
      tool.spent = true;
      return show_error(session, "The loops cannot be closed, so nothing can be pulled along its joints.");
    }
    if (const auto normal = grab.drag.plane_of(grab.grabbed);
        normal && std::abs(normal->dot(input.camera.backward())) > seen_across)
      grab.plane = {.through = hit.point, .normal = *normal, .of_view = false};
    grab.target = hit.point;
    tool.assembly = std::move(grab);
  } catch (const SceneError& error) {
    tool.spent = true;
    show_error(session, error.what());
  }
}

void hold_assembly(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input) {
  AssemblyGrab& grab = *tool.assembly;
  const bool goes_on = grab.moved && !grab.outcome.settled;
  const auto target = on_plane(grab.plane, input.ray());
  if (input.moved && target && (input.cursor != grab.cursor || goes_on)) {
    grab.cursor = input.cursor;
    grab.target = *target;
    grab.moved = true;
    grab.outcome = grab.drag.pull(
        grab.grabbed,
        {.at = *target, .sight = grab.plane.of_view ? Vec3(input.ray().direction) : Vec3(Vec3::Zero())});
    redraw_grabbed(session, tool, grab.drag.pose());
  }
  draw_assembly(ui, tool, input);
}

void let_go_assembly(Session& session, ToolState& tool, bool keep) {
  const AssemblyGrab& grab = *tool.assembly;
  constexpr double stayed = 1e-9; // of what it was pulled by
  const double by = (grab.target - *grab.grabbed.at).norm();
  if (keep && grab.moved && !grab.outcome.at_stop &&
      (grab.drag.position(grab.grabbed) - *grab.grabbed.at).norm() < stayed * by)
    session.notice = "The joints of " + grab.grabbed.body + " do not let it move.";
  if (!keep && grab.moved) {
    const std::uint64_t gesture = std::exchange(session.gesture, grab.gesture);
    edit(session, grab.step, [&](Mechanism& mechanism, Selection& selection) {
      mechanism = *grab.before;
      selection = grab.selection;
    });
    session.gesture = gesture;
  }
  tool.assembly.reset();
}

} // namespace flyball
