#include "app/ui/view_frame.hpp"

#include "app/session/session.hpp"
#include "app/ui/load_view.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"

namespace flyball {

const std::shared_ptr<const Mechanism>& shown_mechanism(const Session& session, const ToolState& tool) {
  if (session.mode == Mode::build) return session.document.shared();
  if (tool.pull) return tool.pull->mechanism; // the tool draws the hand's spring
  return session.answer.ticket ? session.answer.mechanism : session.document.shared();
}

ViewFrame view_frame(const Session& session, const Ui& ui, const ToolState& tool, const ViewState& view) {
  ViewFrame frame;
  frame.mechanism = shown_mechanism(session, tool).get();
  const bool solved = converged(session) || (periodic_motion(session) && !session.poses.empty());
  if (session.mode == Mode::build) {
    // The answer may still be that to an earlier edit.
    if (tool.assembly) {
      frame.ghost = tool.assembly->start;
    } else if (solved && view.ghost && session.poses.size() == session.mechanism().bodies.size()) {
      frame.ghost = session.poses;
      frame.ghost_pose = GhostPose::steady;
    }
  } else {
    const bool moves = session.motion.poses.size() == frame.mechanism->bodies.size();
    if (solved) {
      frame.poses = session.poses;
      if (view.ghost && session.drawn.size() == session.poses.size()) frame.ghost = session.drawn;
      if (moves && !session.motion.beside) frame.motion = session.motion.poses;
      if (const std::vector<Pose>& mode = session.study.modes.poses;
          moving_mode(session) && !mode.empty() && mode.size() % frame.mechanism->bodies.size() == 0) {
        frame.motion = mode;
        frame.ghost = {}; // three of them would be too much to look at
      }
    } else if (moves) { // what has no steady state moves all the same
      frame.poses = session.motion.poses;
    }
  }
  frame.camera = view.camera;
  frame.theme = ui.theme;
  frame.options.grid = view.grid;
  frame.options.shadow = view.shadow;
  frame.options.scale = ui.scale;
  frame.selected = find_parts(*frame.mechanism, session.selection());
  frame.hovered = view.hovered;
  frame.hidden = find_parts(*frame.mechanism, {view.hidden});
  show_loads(session, tool, view, frame);
  // While a slider is held all arrows would change their lengths at once where these are not chosen.
  if (const std::shared_ptr<const ViewScene>& now = view.scene.scene;
      ui.slider_press.dragging && !frame.load_lengths && now && !now->arrows.arrows.empty() && !now->diagram)
    frame.load_lengths = now->arrows.scales.lengths();
  frame.cut_joints = session.answer.summary.cut_joints;
  frame.colouring = session.document.colouring();
  return frame;
}

ViewFrame motion_frame(const Session& session, const ViewState& view, ViewFrame frame) {
  frame.poses = session.motion.poses;
  frame.ghost = {};
  frame.motion = {};
  show_motion_loads(session, view, frame);
  frame.hovered = {};
  return frame;
}

} // namespace flyball
