#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace flyball {

namespace {

// rad or m.
double value_step(const CoordinateSolution& from, const CoordinateSolution& to) {
  const double step = to.value - from.value;
  const bool turned = from.angle && std::abs(step) > std::numbers::pi;
  return turned ? std::remainder(step, 2 * std::numbers::pi) : step;
}

} // namespace

double value_difference(const CoordinateSolution& from, const CoordinateSolution& to) {
  return from.driven || to.driven ? 0 : value_step(from, to) / from.scale;
}

double speed_difference(const CoordinateSolution& from, const CoordinateSolution& to) {
  if (!from.speed || !to.speed || from.dependent) return 0;
  const double size = std::max({from.speed_scale, std::abs(*from.speed), std::abs(*to.speed)});
  return (*to.speed - *from.speed) / size;
}

double scaled_distance(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max({most, std::abs(value_difference(a[i], b[i])), std::abs(speed_difference(a[i], b[i]))});
  return most;
}

double squared_distance(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double value = value_difference(a[i], b[i]), speed = speed_difference(a[i], b[i]);
    sum += value * value + speed * speed;
  }
  return sum;
}

std::vector<CoordinateSolution> coordinates_between(const std::vector<CoordinateSolution>& a,
                                                    const std::vector<CoordinateSolution>& b, double part) {
  std::vector<CoordinateSolution> out = part < 0.5 ? a : b;
  for (std::size_t i = 0; i < out.size() && i < a.size() && i < b.size(); ++i) {
    out[i].value = a[i].value + part * value_step(a[i], b[i]);
    if (a[i].speed && b[i].speed) out[i].speed = *a[i].speed + part * (*b[i].speed - *a[i].speed);
  }
  return out;
}

} // namespace flyball
