// What the Edit menu does with the selected parts.
#pragma once

#include "app/document/gear_kinds.hpp"

namespace flyball {

struct App;
struct Session;

void delete_selected(App& app);
void duplicate_selected(App& app);
void copy_selected(Session& session); // to the clipboard, as text
void cut_selected(Session& session);
void paste_parts(App& app);
void select_all(Session& session);
void show_mirror_dialog(App& app);
void show_circular_dialog(App& app);
// Joins the selected joints by a gear, belt, rack or screw: the first coordinates of two, or of one, that
// this can tie.
void gear_selected(Session& session, GearKind kind);
bool can_gear_selected(const Session& session, GearKind kind);

void mirror_dialog(App& app);
void circular_dialog(App& app);

// Of the gear that alone is selected.
bool can_give_backlash(const Session& session);
void give_backlash_to_selected(Session& session);

} // namespace flyball
