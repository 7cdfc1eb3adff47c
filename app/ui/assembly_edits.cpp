#include "app/ui/assembly_edits.hpp"

#include "app/document/redraw.hpp"
#include "app/session/session.hpp"
#include "app/session/settled_pose.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/solve/assembly_drag.hpp"

#include <cmath>

namespace flyball {

void redraw(Session& session, const std::string& step, const Mechanism& before, const MechanismPose& pose,
            const Selection& selection) {
  Redrawn next = redrawn(before, pose);
  edit(session, step, [&](Mechanism& mechanism, Selection& selected) {
    mechanism = std::move(next.mechanism);
    selected = selection;
  });
  if (!next.along_other_axes.empty())
    session.notice = "What acts along single axes of " + name_list(next.along_other_axes) +
                     " acts along the world's now, as its parent has turned.";
  if (!next.slack_elsewhere.empty())
    session.notice = "Bearings are slack as they are drawn: what is held by " +
                     name_list(next.slack_elsewhere) + " settles elsewhere now.";
}

void move_coordinate(Session& session, const std::string& joint, int index, double value) {
  constexpr double there = 1e-9; // rad or m
  if (!std::isfinite(value)) return;
  const auto before = session.document.steps()[session.document.position()].mechanism;
  try {
    AssemblyDrag drag(*before);
    if (!drag.assembled()) return show_error(session, "The loops cannot be closed, so nothing can be moved.");
    DragOutcome out = drag.move(joint, index, value);
    // As long as it takes, but not for ever.
    for (int i = 0; i < 20 && !out.settled; ++i)
      out = drag.move(joint, index, value);
    redraw(session, "Move " + joint, *before, drag.pose(), session.selection());
    if (out.away > there)
      session.notice =
          joint + (out.at_stop ? " is kept from there by a stop." : " is kept from there by its loops.");
  } catch (const SceneError& error) {
    show_error(session, error.what());
  }
}

bool can_draw_settled(const Session& session, const ToolState& tool) {
  return converged(session) && !solving(session) && !tool.pull &&
         session.answer.solution.poses.size() == session.document.stored().bodies.size();
}

void draw_settled(Session& session) {
  const Mechanism before = session.document.stored();
  const MechanismPose pose = settled_pose(before, session.answer.solution);
  if (is_drawn_in(before, pose)) {
    session.notice = "It is drawn as it settles already.";
    return;
  }
  redraw(session, "Draw as it settles", before, pose, session.selection());
}

} // namespace flyball
