#include "engine/periodic/orbit_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

// The greatest value of sign * the polynomial through seven samples about the greatest one.
double extreme(std::span<const double> values, std::size_t stride, double sign) {
  const std::size_t n = (values.size() - 1) / stride;
  std::size_t best = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (sign * values[i * stride] > sign * values[best * stride]) best = i;
  const auto at = [&](int k) { // samples on from the best
    return values[(best + n + static_cast<std::size_t>(k + static_cast<int>(n))) % n * stride];
  };
  if (n < 7) return values[best * stride];
  const auto polynomial = [&](double x) {
    double sum = 0;
    for (int i = -3; i <= 3; ++i) {
      double weight = 1;
      for (int j = -3; j <= 3; ++j)
        if (j != i) weight *= (x - j) / (i - j);
      sum += weight * at(i);
    }
    return sign * sum;
  };
  // Golden sections.
  constexpr double golden = 0.6180339887498949;
  double low = -1, high = 1;
  double x = high - golden * (high - low), y = low + golden * (high - low);
  double fx = polynomial(x), fy = polynomial(y);
  while (high - low > 1e-9) {
    if (fx > fy) {
      high = y;
      y = x;
      fy = fx;
      x = high - golden * (high - low);
      fx = polynomial(x);
    } else {
      low = x;
      x = y;
      fx = fy;
      y = low + golden * (high - low);
      fy = polynomial(y);
    }
  }
  return sign * std::max({fx, fy, sign * values[best * stride]});
}

PeriodicRange range_with(std::span<const double> values, std::size_t stride) {
  PeriodicRange out;
  const std::size_t n = (values.size() - 1) / stride;
  for (std::size_t i = 0; i < n; ++i)
    out.mean += values[i * stride];
  out.mean /= static_cast<double>(n);
  out.least = extreme(values, stride, -1);
  out.most = extreme(values, stride, 1);
  return out;
}

double largest_difference(const PeriodicRange& a, const PeriodicRange& b) {
  return std::max({std::abs(a.mean - b.mean), std::abs(a.least - b.least), std::abs(a.most - b.most)});
}

// Less an even share of whole turns.
PeriodicRange range_of_track(const CoordinateTrack& track, int& turns) {
  if (track.rotation) // a rotation vector that turns over jumps
    for (std::size_t i = 1; i < track.value.size(); ++i)
      if (std::abs(track.value[i] - track.value[i - 1]) > 3) return {unknown, unknown, unknown, unknown};
  turns = track.angle && !track.rotation
              ? static_cast<int>(std::lround((track.value.back() - track.value.front()) / turn))
              : 0;
  std::vector<double> values = track.value;
  const double share = turn * turns / static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= share * static_cast<double>(i);
  return range_over_period(values);
}

void compare(const PeriodicRange& other, PeriodicRange& out) {
  out.error += largest_difference(other, out);
}

} // namespace

PeriodicRange range_over_period(std::span<const double> values) {
  if (std::ranges::any_of(values, [](double v) { return !std::isfinite(v); }))
    return {unknown, unknown, unknown, unknown};
  PeriodicRange out = range_with(values, 1);
  const double size = std::max(std::abs(out.least), std::abs(out.most));
  out.error = largest_difference(out, range_with(values, 2)) + rounding * size;
  return out;
}

void fill_ranges(const Run& run, PeriodicState& out) {
  for (const CoordinateTrack& track : run.coordinates) {
    if (track.driven) continue;
    PeriodicCoordinate c{track.joint, track.index, track.count, track.angle, track.dependent, 0, {}};
    c.range = range_of_track(track, c.turns);
    out.coordinates.push_back(std::move(c));
  }
  for (const DriveTrack& track : run.drives)
    out.drive_torques.push_back(
        {track.joint, track.index, track.count, track.angle, range_over_period(track.torque)});
  for (const MeasureTrack& track : run.measures)
    out.measures.push_back({track.name, track.unit, range_over_period(track.value)});
}

void compare_ranges(const PeriodicState& other, PeriodicState& out) {
  for (std::size_t i = 0; i < out.coordinates.size(); ++i)
    compare(other.coordinates[i].range, out.coordinates[i].range);
  for (std::size_t i = 0; i < out.drive_torques.size(); ++i)
    compare(other.drive_torques[i].range, out.drive_torques[i].range);
  for (std::size_t i = 0; i < out.measures.size(); ++i)
    compare(other.measures[i].range, out.measures[i].range);
}

} // namespace flyball
