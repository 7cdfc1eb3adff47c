#include "app/plot/shapes.hpp"

namespace flyball {

PixelLine shape_corners(PlotShape shape, double diameter) {
  const double r = diameter / 2, half = 0.89 * r; // a square of the circle's area
  switch (shape) {
  case PlotShape::square: return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  case PlotShape::diamond: return {{0, -1.25 * r}, {1.25 * r, 0}, {0, 1.25 * r}, {-1.25 * r, 0}};
  case PlotShape::triangle: return {{0, -1.35 * r}, {1.17 * r, 0.68 * r}, {-1.17 * r, 0.68 * r}};
  default: return {};
  }
}

PixelLine shape_strokes(PlotShape shape, double diameter) {
  const double r = 0.55 * diameter, d = 0.75 * r;
  if (shape == PlotShape::plus) return {{-r, 0}, {r, 0}, {0, -r}, {0, r}};
  if (shape == PlotShape::cross) return {{-d, -d}, {d, d}, {-d, d}, {d, -d}};
  return {};
}

} // namespace flyball
