// A plot of SI values in the units that a person has chosen.
#pragma once

#include "app/plot/plot.hpp"
#include "app/session/units.hpp"

namespace flyball {

// Converts all that the plot has along an axis (0: x, 1: y), but its marker, from `unit` into what is shown
// for that.
void show_axis(Plot& plot, int axis, const std::string& unit, const DisplayUnits& units);
// The same for the values of a map.
void show_heat(PlotHeat& heat, const std::string& unit, const DisplayUnits& units);

} // namespace flyball
