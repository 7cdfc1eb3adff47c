// The Campbell diagram as a plot.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// Makes app.plots.campbell.plot where something of it has changed.
void draw_campbell(App& app);

} // namespace flyball
