// A hand at a body: while building it moves along its joints (tools_assembly.cpp), while exploring a spring
// pulls it (tools_pull.cpp), or sliders bring it where the hand is (tools_reach.cpp).
#pragma once

#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/tools/hand_state.hpp"
#include "app/viewport/picking.hpp"

namespace flyball {

// Before the other tools. Whether the hand has hold of something, so that the button is not theirs.
bool use_hand(const ViewContext& context, const ViewInput& input);
// Lets go of what it has hold of; `keep`: otherwise everything is where it was. False where it had nothing.
bool let_go_hand(Session& session, ToolState& tool, bool keep);
// What to do next while it has hold of something, in a line; else empty.
std::string hand_hint(const ToolState& tool);

// The body under the cursor in what is shown, and where it is met.
struct HandHit {
  std::string body;
  Vec3 point = Vec3::Zero(); // m, world
};
std::optional<HandHit> body_under_cursor(const ViewContext& context, const ViewInput& input);
// Where the cursor is on the plane; nothing where one looks along it.
std::optional<Vec3> on_plane(const HandPlane& plane, const Ray& ray);

// Asks for the steady state of this mechanism from these coordinates, and, for a point that the hand is at,
// how to take hold of it (LiveAnswer::grip).
void ask_held(Session& session, std::shared_ptr<const Mechanism> mechanism,
              std::vector<std::pair<std::string, double>> start, std::optional<BodyPoint> grip, bool nearest);

// Of each.
void take_assembly(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit);
void hold_assembly(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input);
void let_go_assembly(Session& session, ToolState& tool, bool keep);
void take_pull(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit);
void hold_pull(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input);
void let_go_pull(Session& session, ToolState& tool, bool keep);
// Takes what has been found since: how to take hold, and what it settles in once it is let go.
void follow_pull(Session& session, ToolState& tool);

void take_reach(Session& session, ToolState& tool, const ViewInput& input, const HandHit& hit);
void hold_reach(Session& session, const Ui& ui, ToolState& tool, const ViewInput& input);
void let_go_reach(Session& session, ToolState& tool, bool keep);
void follow_reach(const Session& session, ToolState& tool);

// N, with which the hand pulls now; nothing where it does not.
std::optional<double> hand_force(const Session& session, const ToolState& tool);

} // namespace flyball
