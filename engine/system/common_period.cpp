#include "engine/system/common_period.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

std::optional<double> common_period(const std::vector<double>& speeds, int most) {
  if (speeds.empty()) return {};
  const double slowest =
      std::abs(*std::ranges::min_element(speeds, {}, [](double s) { return std::abs(s); }));
  if (!(slowest > 0)) return {};
  for (int turns = 1; turns <= most; ++turns) {
    const double base = slowest / turns; // rad/s
    const bool whole = std::ranges::all_of(speeds, [&](double s) {
      const double ratio = std::abs(s) / base;
      return ratio < most + 0.5 && std::abs(ratio - std::round(ratio)) <= same_speed * ratio;
    });
    if (whole) return 2 * std::numbers::pi / base;
  }
  return {};
}

} // namespace flyball
