// Whether a body that is moved takes its joints along, and what is said about it.
#pragma once

#include "app/document/transform.hpp"

namespace flyball {

struct Session;
struct ToolState;

// As chosen in the inspector; `opposite` while Shift is held in the view.
OuterJoints joints_of_moved(const ToolState& tool, bool opposite);
// Tells which joints went along with the selected bodies and what they are joined to that stays, or which
// joints were left. After the edit; nothing where they have none to what stays.
void tell_joints(Session& session, const ToolState& tool, const Selection& moved, bool opposite);

} // namespace flyball
