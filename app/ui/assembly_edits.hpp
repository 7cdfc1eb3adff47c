// Edits that draw the mechanism in another of its configurations: the mechanism stays the same.
#pragma once

#include "app/document/part.hpp"
#include "engine/mechanism/mechanism_pose.hpp"

namespace flyball {

struct Session;
struct ToolState;

// The state of the history `before` in this pose, as a step of that name and gesture. Tells of springs that
// could not come along.
void redraw(Session& session, const std::string& step, const Mechanism& before, const MechanismPose& pose,
            const Selection& selection);
// The coordinate (rad or m) brought to a value, as far as joints and stops allow; says where they do not.
void move_coordinate(Session& session, const std::string& joint, int index, double value);
// The drawn pose becomes that of the steady state.
bool can_draw_settled(const Session& session, const ToolState& tool);
void draw_settled(Session& session);

} // namespace flyball
