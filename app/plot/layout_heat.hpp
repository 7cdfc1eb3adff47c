// The cells of a heat map in pixels.
#pragma once

#include "app/plot/layout.hpp"

namespace flyball {

// Of its colours: the map's own range, or that of its values.
PlotRange heat_range(const PlotHeat& heat);
// Neighbours of the same colour as one; of a finer grid than can be seen a part.
std::vector<PlotCell> heat_cells(const PlotHeat& heat, const PlotLayout& layout);
// The cell that holds a point, by column and row; none outside.
std::optional<std::array<std::size_t, 2>> heat_cell(const PlotHeat& heat, double x, double y,
                                                    bool x_logarithmic, bool y_logarithmic);

} // namespace flyball
