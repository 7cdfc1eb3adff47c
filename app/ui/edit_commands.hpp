// What the Edit menu does with the selected parts.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

void delete_selected(App& app);
void duplicate_selected(App& app);
void copy_selected(App& app); // to the clipboard, as text
void cut_selected(App& app);
void paste_parts(App& app);
void select_all(App& app);
void show_mirror_dialog(App& app);
void show_circular_dialog(App& app);
// Joins the selected joints by a gear, belt, rack or screw: the first coordinates of two, or of one, that
// this can tie.
void gear_selected(App& app, GearKind kind);
bool can_gear_selected(const App& app, GearKind kind);

void mirror_dialog(App& app);
void circular_dialog(App& app);

// Of the gear that alone is selected.
bool can_give_backlash(const App& app);
void give_backlash_to_selected(App& app);

} // namespace flyball
