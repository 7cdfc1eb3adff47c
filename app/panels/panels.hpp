// The parts of the interface, one file each.
#pragma once

#include "app/panels/app.hpp"
#include "app/panels/layout.hpp"

namespace flyball {

void toolbar_panel(App& app, const PanelRect& rect);
void viewport_panel(App& app, const PanelRect& rect);
void parameters_panel(App& app, const PanelRect& rect);
void results_panel(App& app, const PanelRect& rect);
void open_dialog(App& app);
void export_dialog(App& app);

// Sections of the results.
void coordinate_results(App& app);
void solver_results(App& app);
void load_results(App& app); // drive torques, reactions
void eigenvalue_results(App& app);
void system_results(App& app);
// The residual after each iteration, on a logarithmic scale.
void history_plot(App& app, float width, float height);

// Elevation (rad) from which three axes at right angles look alike.
inline constexpr double isometric_elevation = 0.6154797086703873;

// Keys that work whenever nothing is being typed.
void handle_shortcuts(App& app);
// Asks for a dialog; the next frame opens it.
void show_open_dialog(App& app);
void show_export_dialog(App& app);

} // namespace flyball
