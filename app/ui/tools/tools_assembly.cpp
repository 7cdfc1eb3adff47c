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

void draw_assembly(App& app, const ViewInput& input) {
  const AssemblyGrab& grab = *app.tool.assembly;
  const auto at = input.on_screen(grab.drag.position(grab.grabbed)), to = input.on_screen(grab.target);
  if (!at) return;
  // A line to the hand where it is out of reach.
  if (grab.moved && to && std::hypot(to->x - at->x, to->y - at->y) > 3 * app.scale)
    draw_line(app, *at, *to, palette(app.theme).accent, 1.5f);
  draw_dot(app, *at, 5, true);
  if (grab.moved)
    draw_tag(app, input, input.cursor,
             grab.outcome.at_stop ? grab.grabbed.body + " at a stop" : grab.grabbed.body, "");
}

// An edit of the drag, whatever was pressed meanwhile.
void redraw_grabbed(App& app, const MechanismPose& pose) {
  const AssemblyGrab& grab = *app.tool.assembly;
  const std::uint64_t gesture = std::exchange(app.gesture, grab.gesture);
  redraw(app, grab.step, *grab.before, pose, grab.selection);
  app.gesture = gesture;
}

} // namespace

void take_assembly(App& app, const ViewInput& input, const HandHit& hit) {
  const auto before = app.document.steps()[app.document.position()].mechanism;
  try {
    AssemblyGrab grab{.drag = AssemblyDrag(*before),
                      .grabbed = {hit.body, hit.point},
                      .plane = {.through = hit.point, .normal = input.camera.backward()},
                      .before = before,
                      .start = drawn_poses(*before),
                      .selection = app.selection(),
                      .gesture = app.gesture,
                      .step = "Pull " + hit.body};
    if (!grab.drag.assembled()) {
      app.tool.spent = true;
      return show_error(app, "The loops cannot be closed, so nothing can be pulled along its joints.");
    }
    if (const auto normal = grab.drag.plane_of(grab.grabbed);
        normal && std::abs(normal->dot(input.camera.backward())) > seen_across)
      grab.plane = {.through = hit.point, .normal = *normal, .of_view = false};
    grab.target = hit.point;
    app.tool.assembly = std::move(grab);
  } catch (const SceneError& error) {
    app.tool.spent = true;
    show_error(app, error.what());
  }
}

void hold_assembly(App& app, const ViewInput& input) {
  AssemblyGrab& grab = *app.tool.assembly;
  const bool goes_on = grab.moved && !grab.outcome.settled;
  const auto target = on_plane(grab.plane, input.ray());
  if (input.moved && target && (input.cursor != grab.cursor || goes_on)) {
    grab.cursor = input.cursor;
    grab.target = *target;
    grab.moved = true;
    grab.outcome = grab.drag.pull(
        grab.grabbed,
        {.at = *target, .sight = grab.plane.of_view ? Vec3(input.ray().direction) : Vec3(Vec3::Zero())});
    redraw_grabbed(app, grab.drag.pose());
  }
  draw_assembly(app, input);
}

void let_go_assembly(App& app, bool keep) {
  const AssemblyGrab& grab = *app.tool.assembly;
  constexpr double stayed = 1e-9; // of what it was pulled by
  const double by = (grab.target - *grab.grabbed.at).norm();
  if (keep && grab.moved && !grab.outcome.at_stop &&
      (grab.drag.position(grab.grabbed) - *grab.grabbed.at).norm() < stayed * by)
    app.notice = "The joints of " + grab.grabbed.body + " do not let it move.";
  if (!keep && grab.moved) {
    const std::uint64_t gesture = std::exchange(app.gesture, grab.gesture);
    edit(app, grab.step, [&](Mechanism& mechanism, Selection& selection) {
      mechanism = *grab.before;
      selection = grab.selection;
    });
    app.gesture = gesture;
  }
  app.tool.assembly.reset();
}

} // namespace flyball
