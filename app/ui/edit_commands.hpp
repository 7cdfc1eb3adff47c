// What the Edit menu does with the selected parts.
#pragma once

#include "app/document/gear_kinds.hpp"

#include <string>

namespace flyball {

struct Session;
struct ToolState;
struct ViewState;

void delete_selected(Session& session, const ToolState& tool);
void duplicate_selected(Session& session, const ViewState& view);
void copy_selected(Session& session); // to the clipboard, as text
void cut_selected(Session& session);
void paste_parts(Session& session, const ViewState& view);
void select_all(Session& session);
// Joins the selected joints by a gear, belt, rack or screw: the first coordinates of two, or of one, that
// this can tie.
void gear_selected(Session& session, GearKind kind);
bool can_gear_selected(const Session& session, GearKind kind);

// Of the gear that alone is selected.
bool can_give_backlash(const Session& session);
void give_backlash_to_selected(Session& session);

// Of the body that alone is selected, or that the selected bearing holds.
bool can_drive_in_bearings(const Session& session);
void drive_selected_in_bearings(Session& session);
// Of that body.
void drive_in_bearings(Session& session, const std::string& body);

} // namespace flyball
