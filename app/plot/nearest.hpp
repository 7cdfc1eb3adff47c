// What of a plot is near the pointer.
#pragma once

#include "app/plot/layout.hpp"

namespace flyball {

struct PlotNear {
  std::size_t curve = 0;
  double index = 0; // of the curve's points, with a fraction where it lies between two
  double x = 0, y = 0;
  double distance = 0; // pixels
};

// The nearest data point of the curves shown, no farther than `reach` pixels.
std::optional<PlotNear> nearest_point(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                      double px, double py, double reach);
// The nearest place along the lines through them.
std::optional<PlotNear> nearest_along(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                      double px, double py);

struct PlotReading {
  std::size_t curve = 0; // the first shown of its name
  double y = 0;
  std::string note{}; // of the nearest point
  // Of PlotAlong, between the two points beside it, and how far apart these are.
  std::optional<std::array<double, 2>> along{};
};

// What the curves are at `x`, those of one name (or of none) together: of several crossings the one nearest
// to pixel `py`.
std::vector<PlotReading> readings_at(const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                                     double x, double py);

struct BandReading {
  std::size_t band = 0;
  double lower = 0, upper = 0;
};

// What the bands shown are at `x`; of several parts of one name the one nearest to pixel `py`.
std::vector<BandReading> bands_at(const Plot& plot, const PlotLook& look, const PlotLayout& layout, double x,
                                  double py);

} // namespace flyball
