#include "app/plot/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

std::vector<double> axis_ticks(double lower, double upper, int wanted, bool logarithmic) {
  std::vector<double> ticks;
  if (!(upper > lower) || wanted < 1) return ticks;
  if (logarithmic) {
    const int from = static_cast<int>(std::ceil(std::log10(lower) - 1e-9));
    const int to = static_cast<int>(std::floor(std::log10(upper) + 1e-9));
    const int step = std::max(1, (to - from + wanted) / std::max(1, wanted));
    for (int decade = from; decade <= to; decade += step)
      ticks.push_back(std::pow(10., decade));
    return ticks;
  }
  const double raw = (upper - lower) / wanted, power = std::pow(10., std::floor(std::log10(raw)));
  double step = 10 * power;
  for (double factor : {1., 2., 5.})
    if (raw <= factor * power * (1 + 1e-9)) {
      step = factor * power;
      break;
    }
  // Multiples of the step, so that zero is zero and no rounding piles up.
  for (double i = std::ceil(lower / step - 1e-9); i * step <= upper + 1e-9 * step; ++i)
    ticks.push_back(i * step + 0.);
  return ticks;
}

std::array<double, 2> axis_range(const Plot& plot, int axis) {
  const bool logarithmic = axis == 0 ? plot.x.logarithmic : plot.y.logarithmic;
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  const auto include = [&](const std::array<double, 2>& p) {
    const double value = p[static_cast<std::size_t>(axis)];
    if (!std::isfinite(value) || (logarithmic && value <= 0)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  };
  for (const PlotCurve& c : plot.curves)
    for (const auto& p : c.points)
      include(p);
  for (const PlotMark& m : plot.marks)
    include(m.at);
  if (lower > upper) return {0, 1};
  if (logarithmic) return {lower / 1.5, upper * 1.5};
  // A curve that is flat but for rounding is drawn flat.
  const double flat = 1e-9 * std::max({std::abs(lower), std::abs(upper), 1e-6});
  const double room = upper - lower > flat ? 0.05 * (upper - lower) : std::max(std::abs(lower), 1.) / 10;
  return {lower - room, upper + room};
}

} // namespace flyball
