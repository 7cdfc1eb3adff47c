// Outlines of marks, the same in every back end.
#pragma once

#include "app/plot/polyline.hpp"

namespace flyball {

// Corners of a filled shape about the origin that is as large to the eye as a circle of this diameter; empty
// for circle and the shapes of strokes.
PixelLine shape_corners(PlotShape shape, double diameter);
// Pairs of ends of the strokes of cross and plus; empty for the others.
PixelLine shape_strokes(PlotShape shape, double diameter);

} // namespace flyball
