#include "engine/report/clearance.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

// Points of two lines that are nearest to each other, as parts of the way along each (Ericson, Real-Time
// Collision Detection, 2005, 5.1.9).
struct Nearest {
  double s = 0, t = 0;
};
Nearest nearest(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2) {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  if (a == 0 && e == 0) return {};
  if (a == 0) return {0, std::clamp(f / e, 0., 1.)};
  const double c = d1.dot(r);
  if (e == 0) return {std::clamp(-c / a, 0., 1.), 0};
  const double b = d1.dot(d2), denominator = a * e - b * b;
  double s = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0., 1.) : 0;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0., 1.);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0., 1.);
  }
  return {s, t};
}

} // namespace

Clearance find_clearance(const Kinematics<double>& k, std::span<const Solid> one,
                         std::span<const Solid> other) {
  Clearance least{std::numeric_limits<double>::infinity(), {}, {}};
  for (const Solid& a : one)
    for (const Solid& b : other) {
      const Vec3 a0 = k.point(a.from.link, a.from.at), a1 = k.point(a.to.link, a.to.at),
                 b0 = k.point(b.from.link, b.from.at), b1 = k.point(b.to.link, b.to.at);
      const auto [s, t] = nearest(a0, a1, b0, b1);
      const double gap = (b0 + t * (b1 - b0) - a0 - s * (a1 - a0)).norm() - a.radius - b.radius;
      if (gap < least.gap)
        least = {gap,
                 {a.from.link, a.from.at + s * (a.to.at - a.from.at)},
                 {b.from.link, b.from.at + t * (b.to.at - b.from.at)}};
    }
  return least;
}

} // namespace flyball
