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
  case Result::vz: out.velocity[0] = Vec3::Unit(axis_of(result, Result::vx)); break;
  case Result::speed: out.velocity[0] = direction(velocity_of(k, points[0])); break;
  case Result::distance:
    out.place[1] = direction(from_to(k, points[0], points[1]));
    out.place[0] = -out.place[1];
    break;
  case Result::angle: {
    const Vec3 u = from_to(k, points[1], points[0]), w = from_to(k, points[1], points[2]);
    const Vec3 a = u.normalized(), b = w.normalized();
    const Vec3 across = a.cross(b);
    const double sine = across.norm(), cosine = a.dot(b);
    // By the normal of its plane, which keeps an angle of 0 or pi that nothing moves without rates although
    // rounding alone gives that normal.
    const Vec3 n = across / sine;
    const auto turned = [](const Vec3& by, const Vec3& arm, double length) {
      return Vec3((by - by.dot(arm) * arm) / length);
    };
    out.place[0] = turned(cosine * b.cross(n) - sine * b, a, u.norm());
    out.place[2] = turned(cosine * n.cross(a) - sine * a, b, w.norm());
    out.place[1] = -out.place[0] - out.place[2];
    break;
  }
  default: break;
  }
  return out;
}

bool is_spring_force(Result result) {
  return result >= Result::tension && result <= Result::force;
}

PointQuantityRates spring_force_rates(Result result, const PointSpringElement& element,
                                      const PointSpringParameters& p, const Kinematics<double>& k) {
  const SpringState<double> s = spring_state(element, p, k);
  const Vec3 relative = k.velocity(element.ends.b, s.b) - k.velocity(element.ends.a, s.a);
  const double along = s.direction.dot(relative);
  // Of the direction with the way between the points.
  const auto across = [&](const Vec3& n) {
    return s.length > 0 ? Vec3((n - n.dot(s.direction) * s.direction) / s.length) : Vec3(Vec3::Zero());
  };
  const double damping = p.damped() ? p.resistance_slope(along) : 0;
  Vec3 place = p.pull_slope(s.length) * s.direction + damping * across(relative),
       velocity = damping * s.direction;
  if (result == Result::force) {
    const double sign = s.tension > 0 ? 1 : s.tension < 0 ? -1 : 0;
    place *= sign;
    velocity *= sign;
  } else if (result != Result::tension) {
    const int axis = axis_of(result, Result::force_x);
    if (p.without_length()) // where its points meet, too
      place = -p.stiffness * Vec3::Unit(axis);
    else
      place = -s.direction[axis] * place - s.tension * across(Vec3::Unit(axis));
    velocity *= -s.direction[axis];
  }
  PointQuantityRates out;
  out.place[0] = -place;
  out.place[1] = place;
  out.velocity[0] = -velocity;
  out.velocity[1] = velocity;
  return out;
}

template double point_quantity<double>(Result, const TrackedPoints&, const Parameters&,
                                       const Kinematics<double>&);
template Dual point_quantity<Dual>(Result, const BasicTrackedPoints<Dual>&, const BasicParameters<Dual>&,
                                   const Kinematics<Dual>&);
template double point_quantity<Extended>(Result, const TrackedPoints&, const Parameters&,
                                         const Kinematics<Extended>&);

} // namespace flyball
