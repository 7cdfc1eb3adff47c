// The parts of the interface, one file each.
#pragma once

#include "app/ui/layout.hpp"

namespace flyball {

struct App;
struct Session;
struct Ui;

void toolbar_panel(App& app, const PanelRect& rect);
void viewport_panel(App& app, const PanelRect& rect);
void view_alone(App& app, const PanelRect& rect);
void beside_panel(App& app, const PanelRect& rect);  // the view of the motion alone
void outline_panel(App& app, const PanelRect& rect); // the parts, as a tree
// The selected parts' numbers; of the whole scene where none is.
void inspector_panel(App& app, const PanelRect& rect);
void parameters_panel(App& app, const PanelRect& rect);
void results_panel(App& app, const PanelRect& rect);
void welcome(App& app, const PanelRect& view); // over the view of an empty document: what to do first
// Seconds shown a second; width in pixels.
void factor_combo(Session& session, Ui& ui, const char* name, float width);
// Solved, solving, or what is missing.
void status_chip(const Session& session, Ui& ui, const PanelRect& view);
void messages_panel(App& app); // what was told before
void history_panel(App& app);  // the steps, to go back to
void start_rename(App& app);   // of the selected part, in its place in the outline
void open_dialog(App& app);
void save_dialog(App& app);
void unsaved_dialog(App& app);
void recovery_dialog(App& app);
void gallery_dialog(App& app);
void export_dialog(App& app);
void report_dialog(App& app);
void model_dialog(App& app);
void movie_dialog(App& app);
void file_banner(App& app, const PanelRect& view); // over the view: what happened to the file on disk

// Elevation (rad) from which three axes at right angles look alike.
inline constexpr double isometric_elevation = 0.6154797086703873;

} // namespace flyball
