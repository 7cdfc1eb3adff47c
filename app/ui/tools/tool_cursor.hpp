// The cursor of the tools that place, where the keyboard moves it: arrows, Page Up and Down from point to
// point of the mechanism, Enter for a click.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"

namespace flyball {

// A key of the cursor; false: none. `view` in pixels.
bool take_cursor_key(const ViewContext& context, const KeyPress& key, ViewSize view);
// Puts the cursor into the place of the mouse, as long as that rests.
void use_tool_cursor(const ViewContext& context, ViewInput& input);
// After the tool was used: what was made with the cursor has the keys next, or the card that asks how.
void follow_tool_cursor(const Session& session, Ui& ui, ToolState& tool, std::uint64_t revision_before,
                        bool joining_before);

} // namespace flyball
