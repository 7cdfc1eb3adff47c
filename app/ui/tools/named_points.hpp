// Named points in the view: marked where they are of use, picked, selected and dragged, and what is put on
// one standing there.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"

#include <string>

namespace flyball {

// The one that is selected, while no part is; null: none.
const NamedPoint* selected_point(const Session& session, const ToolState& tool);
void select_point(Session& session, ToolState& tool, const std::string& name);

// Draws them while building, where nothing is selected or a tool or a drag may snap to them, and finds the
// one under the cursor: on its name, or on its place where no part is in front.
void use_points(const ViewContext& context, const ViewInput& input);
// After the panels: chooses the tool that picks one, where a field has asked for it (FieldState::picking).
void begin_picking(Session& session, Ui& ui, ToolState& tool);
// The tool that picks one where app.tool.standing shall stand.
void pick_point(Session& session, ToolState& tool, const ViewInput& input);

// What was put on a named point refers to it; nothing for an empty name.
void stand_at(Mechanism& mechanism, const std::string& vector, const std::string& name);

} // namespace flyball
