// Computes the map of two parameters in the background. No drawing.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// Takes what was computed; computes what was chosen, and anew after changes where that takes no time to speak
// of.
void update_map(App& app);
void compute_map(App& app); // all of it
void cancel_map(App& app);
// Everything goes but what was chosen.
void close_map(App& app);
bool computing_map(const App& app);
Progress map_progress(const App& app);
double map_seconds(const App& app); // since it was begun

// Addresses of the numbers that may be varied: those with a slider first, then every other unless they are
// very many.
std::vector<std::string> map_addresses(const App& app);
// An axis over the number, with the range of its slider or of one that suits it.
MapAxis map_axis(const App& app, const std::string& address);
// The coordinate that is shown, with its present value; null where there is none.
const CoordinateSolution* map_coordinate(const App& app);
// Both parameters, as one step of the history.
void go_to_place(App& app, const std::array<double, 2>& place);
// Makes map.plot where something of it has changed.
void draw_map(App& app);

} // namespace flyball
