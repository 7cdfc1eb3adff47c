// The map as a plot: colours, hatching where it is unstable, the curves in it and the present place.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// Makes app.plots.map.plot where something of it has changed.
void draw_map(App& app);

} // namespace flyball
