// How the gizmo looks.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"

namespace flyball {

void draw_handles(const Ui& ui, const ViewInput& input, const std::vector<HandleShape>& shapes, Handle lit);
// What is held: how far it has come, along what, and what it snapped to.
void draw_grabbed(const Session& session, const Ui& ui, const ToolState& tool, const ViewInput& input);

} // namespace flyball
