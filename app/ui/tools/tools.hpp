// The tools of the view, one file each. Every frame each of them draws over the picture what it is about to
// do, and then does what the hand asks for.
#pragma once

#include "app/document/create.hpp"
#include "app/session/session.hpp"
#include "app/ui/panels/view_input.hpp"
#include "app/ui/tool_state.hpp"
#include "app/viewport/picking.hpp"

namespace flyball {

struct ViewContext;

void set_tool(Session& session, Ui& ui, ToolState& tool, Tool wanted);
// Drops what was begun of a tool that is no longer chosen, or with parts that are gone.
void keep_tool_state(Session& session, ToolState& tool);
// Whether dragging with the left button is the tool's business and does not turn the view.
bool takes_left_drag(const ToolState& tool, const ViewState& view, const ViewInput& input);
// Escape: takes back a drag, or else what was begun of the tool, or else ends the tool. False where there is
// nothing of the kind.
bool step_back(Session& session, ToolState& tool);
// Takes the keys that the tools have a use for out of ui.keys; before the shortcuts.
void take_tool_keys(Session& session, Ui& ui, ToolState& tool);
// What to do next, in a line; empty where there is nothing to say.
std::string tool_hint(const Session& session, const ToolState& tool);

// Moving and turning with the gizmo, and moving the ends of the selected spring or link.
void use_gizmo(const ViewContext& context, const ViewInput& input);
// Lets go of what is held; unless it is to be kept, everything is where it was.
void let_go(Session& session, ToolState& tool, bool keep);
// Clicking and framing parts.
std::optional<Hit> part_under_cursor(const ViewContext& context, const ViewInput& input);
void use_selecting(const ViewContext& context, const ViewInput& input);
void use_placing(const ViewContext& context, const ViewInput& input);    // ball, block, plate
void use_connecting(const ViewContext& context, const ViewInput& input); // rod, link, spring, damper
void use_forces(const ViewContext& context, const ViewInput& input);     // force, torque, drag, vane
void use_joining(const ViewContext& context, const ViewInput& input);
// Or bearing, of tool.joint, and ends it; false where it cannot be made.
bool make_joint(Session& session, Ui& ui, ToolState& tool);

void tool_strip(Session& session, Ui& ui, ToolState& tool, const PanelRect& view);
void joint_card(const ViewContext& context,
                const ViewInput& input); // what a joint or bearing will be, beside its point

// After a tool has made something: chosen again while Shift is held, else it is time to select.
void end_tool(ToolState& tool, const ViewInput& input);
// Whether the tool places something with a click.
bool places(Tool tool);

// Cached until the mechanism changes.
const std::vector<SnapPoint>& cached_snap_points(const Session& session, ToolState& tool);
const SceneList& cached_scene(const ViewContext& context);                  // of the drawn pose
std::optional<Vec3> cached_centre(const Session& session, ToolState& tool); // of the selection
// Of the selected spring or link, where it alone is selected; else none. Their indices are those of PointId.
const std::vector<Vec3>& cached_ends(const Session& session, ToolState& tool);

} // namespace flyball
