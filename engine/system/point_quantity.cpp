#include "engine/system/point_quantity.hpp"

#include "engine/system/extended.hpp"

#include <limits>

namespace flyball {
namespace {

// Of a point: in the numbers of the kinematics, from Parameters::origin.
template <class S>
Vec3T<S> place_in(const Kinematics<S>& k, const BasicTrackedPoint<NumberOf<S>>& point) {
  return k.point(point.link, point.at);
}

template <class S>
Vec3T<NumberOf<S>> velocity_of(const Kinematics<S>& k, const BasicTrackedPoint<NumberOf<S>>& point) {
  const LinkState<S>& x = k.at(point.link);
  const Vec3T<S> arm = x.R * point.at.template cast<S>();
  return (x.v + x.w.cross(arm)).template cast<NumberOf<S>>();
}

// Differences are formed before they are rounded.
template <class S>
Vec3T<NumberOf<S>> from_to(const Kinematics<S>& k, const BasicTrackedPoint<NumberOf<S>>& a,
                           const BasicTrackedPoint<NumberOf<S>>& b) {
  return (place_in(k, b) - place_in(k, a)).template cast<NumberOf<S>>();
}

template <class N>
N angle_between(const Vec3T<N>& a, const Vec3T<N>& b) {
  using std::atan2;
  if (a.squaredNorm() == N(0) || b.squaredNorm() == N(0)) return std::numeric_limits<double>::quiet_NaN();
  return atan2(N(a.cross(b).norm()), N(a.dot(b)));
}

int axis_of(Result result, Result first) {
  return static_cast<int>(result) - static_cast<int>(first);
}

} // namespace

bool is_of_velocity(Result result) {
  return result == Result::vx || result == Result::vy || result == Result::vz || result == Result::speed;
}

template <class S>
NumberOf<S> point_quantity(Result result, const BasicTrackedPoints<NumberOf<S>>& points,
                           const ParametersOf<S>& p, const Kinematics<S>& k) {
  using N = NumberOf<S>;
  switch (result) {
  case Result::x:
  case Result::y:
  case Result::z: {
    const LinkState<S>& x = k.at(points[0].link);
    const Vec3T<S> arm = x.R * points[0].at.template cast<S>();
    const int axis = axis_of(result, Result::x);
    return static_cast<N>(S(p.origin[axis]) + x.o[axis] + arm[axis]);
  }
  case Result::vx:
  case Result::vy:
  case Result::vz: return velocity_of(k, points[0])[axis_of(result, Result::vx)];
  case Result::speed: return velocity_of(k, points[0]).norm();
  case Result::distance: return from_to(k, points[0], points[1]).norm();
  case Result::angle:
    return angle_between<N>(from_to(k, points[1], points[0]), from_to(k, points[1], points[2]));
  default: return std::numeric_limits<double>::quiet_NaN(); // not of points
  }
}

PointQuantityRates point_rates_of(Result result, const TrackedPoints& points, const Kinematics<double>& k) {
  PointQuantityRates out;
  switch (result) {
  case Result::x:
  case Result::y:
  case Result::z: out.place[0] = Vec3::Unit(axis_of(result, Result::x)); break;
  case Result::vx:
  case Result::vy:
  case Result::vz: out.velocity = Vec3::Unit(axis_of(result, Result::vx)); break;
  case Result::speed: out.velocity = direction(velocity_of(k, points[0])); break;
  case Result::distance:
    out.place[1] = direction(from_to(k, points[0], points[1]));
    out.place[0] = -out.place[1];
    break;
  case Result::angle: {
    const Vec3 u = from_to(k, points[1], points[0]), w = from_to(k, points[1], points[2]);
    const Vec3 a = u.normalized(), b = w.normalized();
    const double sine = a.cross(b).norm(), cosine = a.dot(b);
    out.place[0] = -(b - cosine * a) / (u.norm() * sine);
    out.place[2] = -(a - cosine * b) / (w.norm() * sine);
    out.place[1] = -out.place[0] - out.place[2];
    break;
  }
  default: break;
  }
  return out;
}

template double point_quantity<double>(Result, const TrackedPoints&, const Parameters&,
                                       const Kinematics<double>&);
template Dual point_quantity<Dual>(Result, const BasicTrackedPoints<Dual>&, const BasicParameters<Dual>&,
                                   const Kinematics<Dual>&);
template double point_quantity<Extended>(Result, const TrackedPoints&, const Parameters&,
                                         const Kinematics<Extended>&);

} // namespace flyball
