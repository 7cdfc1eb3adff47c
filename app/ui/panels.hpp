// The parts of the interface, one file each.
#pragma once

#include "app/ui/app.hpp"
#include "app/ui/layout.hpp"

namespace flyball {

void toolbar_panel(App& app, const PanelRect& rect);
void viewport_panel(App& app, const PanelRect& rect);
void view_alone(App& app, const PanelRect& rect);
void beside_panel(App& app, const PanelRect& rect);  // the view of the motion alone
void outline_panel(App& app, const PanelRect& rect); // the parts, as a tree
void inspector_panel(App& app,
                     const PanelRect& rect); // the selected parts' numbers; of the whole scene where none is
void parameters_panel(App& app, const PanelRect& rect);
void results_panel(App& app, const PanelRect& rect);
void welcome(App& app, const PanelRect& view); // over the view of an empty document: what to do first
void factor_combo(App& app, const char* name, float width); // seconds shown a second; width in pixels
void status_chip(App& app, const PanelRect& view);          // solved, solving, or what is missing
void messages_panel(App& app);                              // what was told before
void history_panel(App& app);                               // the steps, to go back to
void start_rename(App& app); // of the selected part, in its place in the outline
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

// Sections of the results.
void coordinate_results(App& app);
void measure_results(App& app);
void friction_results(App& app); // of a mechanism with friction: its band, and what holding takes
void periodic_results(App& app); // where a drive makes the balance turn: the motion in its place
void solver_results(App& app);
void pull_results(App& app); // while a hand pulls
void body_results(App& app); // position, speed and acceleration of the selected bodies
void load_results(App& app); // drive torques, reactions
void eigenvalue_results(App& app);
void system_results(App& app);
// The residual after each iteration, on a logarithmic scale.
void history_plot(App& app, float width, float height);

// Elevation (rad) from which three axes at right angles look alike.
inline constexpr double isometric_elevation = 0.6154797086703873;

} // namespace flyball
