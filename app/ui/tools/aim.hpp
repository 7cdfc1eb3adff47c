// Where in space the cursor is, and on which body.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"

namespace flyball {

// Whether the next movement snaps: as chosen, or the opposite while Ctrl is held.
bool snaps(const ToolState& tool, const ViewInput& input);
// Of the grid as one sees it from here (m).
double grid_step(const ViewInput& input);
// The place under the cursor: a point of the mechanism, else one of the body there, else one on the work
// plane.
const Aim& aim_at(const ViewContext& context, const ViewInput& input);
// The place marked in the picture, with the grid around it, and its coordinates beside the cursor. `head` is
// a line above them.
void draw_aim(const Session& session, const Ui& ui, const ViewInput& input, const Aim& aim,
              const std::string& head = {});

} // namespace flyball
