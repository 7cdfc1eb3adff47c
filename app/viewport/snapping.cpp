#include "app/viewport/snapping.hpp"

#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double same_place = 0.5; // pixels

} // namespace

const SnapPoint* snap_point(std::span<const SnapPoint> points, const ViewCamera& camera, ViewSize view,
                            Vec2 cursor, double reach) {
  const SnapPoint* best = nullptr;
  double nearest = 1.5 * reach, front = 0;
  for (const SnapPoint& candidate : points) {
    const auto pixel = camera.project(candidate.point, view);
    if (!pixel) continue;
    double gap = (*pixel - cursor).norm();
    if (gap > reach) continue;
    if (candidate.face) gap += reach / 2;
    const double toward = camera.backward().dot(candidate.point - camera.target);
    const bool nearer = gap < nearest - same_place || (gap <= nearest + same_place && toward > front);
    if (best && !nearer) continue;
    best = &candidate;
    nearest = gap;
    front = toward;
  }
  return best;
}

double step_above(double size) {
  if (!(size > 0) || !std::isfinite(size)) return 1;
  const int exponent = static_cast<int>(std::floor(std::log10(size)));
  for (const int e : {exponent, exponent + 1})
    for (const double digit : {1.0, 2.0, 5.0}) {
      // Divided, because powers of ten below one are not exact.
      const double step = e < 0 ? digit / std::pow(10.0, -e) : digit * std::pow(10.0, e);
      if (step >= size * (1 - 1e-9)) return step;
    }
  return std::pow(10.0, exponent + 1);
}

double nearest_step(double size) {
  const double above = step_above(size), below = step_above(above / 2.6);
  return above / size < size / below ? above : below;
}

double round_to(double value, double step) {
  const double count = std::round(value / step) + 0.0; // never -0
  return step < 1 ? count / std::round(1 / step) : count * step;
}

Vec3 on_grid(const Vec3& point, const std::array<bool, 3>& free, double step) {
  Vec3 rounded = point;
  for (int i = 0; i < 3; ++i)
    if (free[static_cast<std::size_t>(i)]) rounded[i] = round_to(point[i], step);
  return rounded;
}

double round_angle(double angle) {
  constexpr double step = std::numbers::pi / 12;
  return std::round(angle / step) * step;
}

} // namespace flyball
