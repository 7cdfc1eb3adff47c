#include "engine/mechanism/value_table.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// At an end, of the parabola through three points, kept from turning the curve round.
double end_slope(double h, double next_h, double d, double next_d) {
  const double slope = ((2 * h + next_h) * d - h * next_d) / (h + next_h);
  if (slope * d <= 0) return 0;
  if (d * next_d <= 0 && std::abs(slope) > 3 * std::abs(d)) return 3 * d;
  return slope;
}

} // namespace

ValueTable::ValueTable(std::vector<Point> points) : points_(std::move(points)), slopes_(points_.size()) {
  const std::size_t n = points_.size();
  std::vector<double> h, d;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h.push_back(points_[i + 1].x - points_[i].x);
    d.push_back((points_[i + 1].y - points_[i].y) / h.back());
  }
  if (n == 2) {
    slopes_[0] = slopes_[1] = d[0];
    return;
  }
  slopes_.front() = end_slope(h[0], h[1], d[0], d[1]);
  slopes_.back() = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;
    const double before = 2 * h[i] + h[i - 1], after = h[i] + 2 * h[i - 1];
    slopes_[i] = (before + after) / (before / d[i - 1] + after / d[i]);
  }
}

Dual ValueTable::operator()(Dual x) const {
  const auto line = [&](std::size_t i) {
    return Dual{points_[i].y + slopes_[i] * (x.value - points_[i].x), slopes_[i] * x.rate};
  };
  if (x.value <= points_.front().x) return line(0);
  if (x.value >= points_.back().x) return line(points_.size() - 1);
  if (std::isnan(x.value)) return x;
  const auto next = std::ranges::upper_bound(points_, x.value, {}, &Point::x);
  const auto i = static_cast<std::size_t>(next - points_.begin()) - 1;
  const double h = points_[i + 1].x - points_[i].x, s = x.value - points_[i].x;
  const double d = (points_[i + 1].y - points_[i].y) / h;
  const double c = (3 * d - 2 * slopes_[i] - slopes_[i + 1]) / h,
               b = (slopes_[i] - 2 * d + slopes_[i + 1]) / (h * h);
  return {points_[i].y + s * (slopes_[i] + s * (c + s * b)), (slopes_[i] + s * (2 * c + 3 * s * b)) * x.rate};
}

} // namespace flyball
