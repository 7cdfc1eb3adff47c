// Axes: ranges, round ticks with their labels, and the way from values to pixels and back.
#pragma once

#include "app/plot/plot.hpp"

#include <string>
#include <vector>

namespace flyball {

struct AxisTicks {
  std::vector<double> major, minor;
  std::vector<std::string> labels; // of the major ones: as few digits as tell them apart
};

// Round values between the ends, about `wanted` of them and never many more: 1, 2 or 5 times a power of ten.
// On a logarithmic axis decades, or such multiples where it holds less than two of them. None where upper is
// not above lower.
AxisTicks axis_ticks(double lower, double upper, int wanted, bool logarithmic);

// The same of degrees: steps from ten to a turn are parts of one, such as 15, 45 and 90.
AxisTicks degree_ticks(double lower, double upper, int wanted);

// The range that is to be drawn: the look's, the axis's own, or else all that is shown, with a little room.
// {0, 1} where there is nothing ({0.1, 10} if logarithmic); ends that can be drawn in every case.
PlotRange axis_range(const Plot& plot, const PlotLook& look, int axis);

// The nearest range that can be drawn and labelled: rising, not too narrow for doubles, not beyond 1e300.
PlotRange drawable_range(PlotRange range, bool logarithmic);

// Where the cell of a grid point begins and ends: halfway to its neighbours, as the axis is divided.
PlotRange cell_range(const std::vector<double>& grid, std::size_t i, bool logarithmic);

// From a value on an axis to pixels.
struct PlotRuler {
  double lower = 0, upper = 1, from = 0, to = 1;
  bool logarithmic = false;

  double pixel(double value) const; // NaN for what is not positive on a logarithmic axis
  double value(double pixel) const;
  // The same line of values, moved or stretched as the pixels `from` and `to` would be.
  PlotRange range_between(double from_pixel, double to_pixel) const;
};

// A value with the digits that `resolution` (what a pixel means) leaves sensible.
std::string reading_text(double value, double resolution);

} // namespace flyball
