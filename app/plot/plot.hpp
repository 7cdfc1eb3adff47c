// A two-dimensional plot as a value: what is drawn, not how.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace flyball {

struct PlotAxis {
  std::string label; // with its unit: "spin speed [rad/s]"
  bool logarithmic = false;
};

enum class PlotLine { solid, dashed, dotted };

struct PlotCurve {
  std::string name; // in the legend; empty: not there
  std::vector<std::array<double, 2>> points;
  PlotLine line = PlotLine::solid;
  int color = 0; // of the colour-blind-safe palette
};

struct PlotMark {
  std::array<double, 2> at{};
  std::string label;
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotCurve> curves;
  std::vector<PlotMark> marks;
};

// Round values between the ends, about `wanted` of them: 1, 2 or 5 times a power of ten, or powers of ten on
// a logarithmic axis.
std::vector<double> axis_ticks(double lower, double upper, int wanted, bool logarithmic);

// The range of an axis that holds all finite points of the plot, with a little room. {0, 1} where there are
// none.
std::array<double, 2> axis_range(const Plot& plot, int axis);

} // namespace flyball
