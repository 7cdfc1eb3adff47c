// The studies below the view, one file each. They show what was asked for, and nothing is made before.
#pragma once

#include "app/plot/plot.hpp"
#include "app/session/session.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/ui.hpp"

namespace flyball {

struct App;

void study_panel(App& app, const PanelRect& rect);
void motion_panel(App& app);
void motion_transport(Session& session, Ui& ui, float width); // play, scrub; in the present line, pixels
void compare_panel(App& app);
void response_panel(App& app);
void states_panel(Session& session, Ui& ui);
void modes_panel(App& app);
void map_panel(App& app);
void spread_panel(App& app);
void transfer_panel(App& app);

// The name and the unit of what a plot over time can show.
struct MotionQuantity {
  std::string key;   // "value theta"
  std::string title; // "theta"
  std::string group; // "Coordinates"
};
std::vector<MotionQuantity> motion_quantities(const Run& run);
// The quantity over the runs there are, with the steady value.
Plot motion_plot(const Session& session, const std::string& quantity);

} // namespace flyball
