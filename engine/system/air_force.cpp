#include "engine/system/air_force.hpp"

namespace flyball {
namespace {

Mat3 polar_force_slope(const BodyForceParameters& p, const Vec3& normal, const Vec3& span, const Vec3& flow) {
  const double speed = flow.norm();
  if (!(speed > 0)) return Mat3::Zero();
  const Vec3 chord = span.cross(normal);
  const Mat3 turn = normal * chord.transpose() - chord * normal.transpose();
  const Vec3 lifted = turn * flow;
  const Dual incidence(std::atan2(flow.dot(normal), flow.dot(chord)), 1), lift = p.polar->lift(incidence),
                                                                          drag = p.polar->drag(incidence);
  const Mat3 by_speed = (lift.value * lifted + drag.value * flow) * flow.transpose() / speed,
             by_direction = (lift.rate * lifted + drag.rate * flow) * lifted.transpose() / speed,
             by_flow = speed * (lift.value * turn + drag.value * Mat3::Identity());
  return p.quadratic * (by_speed + by_direction + by_flow) * (Mat3::Identity() - span * span.transpose());
}

} // namespace

Mat3 air_force_slope(const BodyForceParameters& p, const Mat3& rotation, const Vec3& flow) {
  if (p.type == ForceType::drag) {
    const double speed = flow.norm();
    Mat3 j = (p.linear + p.quadratic * speed) * Mat3::Identity();
    if (speed > 0) j += p.quadratic / speed * flow * flow.transpose();
    return j;
  }
  const Vec3 normal = rotation * p.normal, span = rotation * p.span;
  const Vec3 across = flow - span * span.dot(flow);
  if (p.polar) return polar_force_slope(p, normal, span, across);
  const double speed = across.norm();
  Mat3 along = p.normal_quadratic * normal * normal.transpose();
  along += p.quadratic * (Mat3::Identity() - span * span.transpose());
  Mat3 j = speed * along;
  if (speed > 0) j += along * across * across.transpose() / speed;
  return j;
}

} // namespace flyball
