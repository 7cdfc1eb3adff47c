// Plots as tables.
#pragma once

#include "app/plot/plot.hpp"

namespace flyball {

// One row a point: curve, x, y, with the axes' labels and units in the header (RFC 4180, lines ending in CR
// LF). Numbers read back exactly; one that is not finite is left empty. Bands follow the curves, "NAME, from"
// and "NAME, to", and marks them under their own labels; the points of a heat map have a fourth column.
// Curves without a name are numbered.
std::string to_csv(const Plot& plot, const PlotLook& look = {});

} // namespace flyball
