// When and of what the view shows loads as arrows.
#pragma once

#include "app/viewport/view_scene.hpp"

#include <string>

namespace flyball {

struct Session;
struct ToolState;
struct ViewState;

// Asks for the arrows in a frame of the steady state, where they are wanted and known: of the one body that
// is selected its free-body diagram, else those of the whole mechanism. Of a periodic motion those at the
// moment that is shown, as of the panel's where it is in the steady state's place; of the whole mechanism
// where there is no diagram (diagram_at()), too.
void show_loads(const Session& session, const ToolState& tool, const ViewState& view, ViewFrame& frame);
// In the frame of the motion's own view those of its moment, to the lengths that they have in the view beside
// it, which was made before: a cycle's are compared with the steady state's.
void show_motion_loads(const Session& session, const ViewState& view, ViewFrame& frame);
// Whether they are one body's free-body diagram, which is in proportion.
bool shows_diagram(const ViewState& view);
// Whether their lengths are by the cube root.
bool shows_roots(const ViewState& view);
// Whether they would be those of a moment of a motion.
bool shows_moment(const Session& session);
// Why there are none though they are wanted, in words; empty where there are.
std::string loads_missing(const Session& session, const ToolState& tool, const ViewState& view);

} // namespace flyball
