#include "engine/system/air_force.hpp"

namespace flyball {

Mat3 air_force_slope(const BodyForceParameters& p, const Mat3& rotation, const Vec3& flow) {
  if (p.type == ForceType::drag) {
    const double speed = flow.norm();
    Mat3 j = (p.linear + p.quadratic * speed) * Mat3::Identity();
    if (speed > 0) j += p.quadratic / speed * flow * flow.transpose();
    return j;
  }
  const Vec3 normal = rotation * p.normal, span = rotation * p.span;
  const Vec3 across = flow - span * span.dot(flow);
  const double speed = across.norm();
  Mat3 along = p.normal_quadratic * normal * normal.transpose();
  along += p.quadratic * (Mat3::Identity() - span * span.transpose());
  Mat3 j = speed * along;
  if (speed > 0) j += along * across * across.transpose() / speed;
  return j;
}

} // namespace flyball
