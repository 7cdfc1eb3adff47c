// The Campbell diagram: the frequencies of the modes over a drive's speed, along the branch of the state that
// is shown.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// Addresses of the drives' speeds.
std::vector<std::string> drive_speeds(const Mechanism& mechanism);
// Drive and range as they were chosen, or as they are at first; no drive: "".
std::string campbell_drive(const App& app);
PlotRange campbell_range(const App& app);

void follow_campbell(App& app);
// Takes what was followed; follows anew after changes of anything but the speed where that takes no time to
// speak of.
void update_campbell(App& app);
// The branch that the state lies on.
std::optional<std::size_t> campbell_branch(const App& app);
// Makes campbell.plot where something of it has changed.
void draw_campbell(App& app);

} // namespace flyball
