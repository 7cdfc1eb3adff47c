// The cells of a heat map in pixels.
#pragma once

#include "app/plot/layout.hpp"

namespace flyball {

// Of its colours: the map's own range, or that of its values.
PlotRange heat_range(const PlotHeat& heat);
// Neighbours of the same colour as one; of a finer grid than can be seen a part.
std::vector<PlotCell> heat_cells(const PlotHeat& heat, const PlotLayout& layout);
// The value of the cell that holds a point; NaN outside.
double heat_value(const PlotHeat& heat, double x, double y, bool x_logarithmic, bool y_logarithmic);

} // namespace flyball
