// Ways to put a thing elsewhere with all its distances kept: shifts, turns, reflections.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>

namespace flyball {

struct Isometry {
  Mat3 linear = Mat3::Identity(); // orthogonal
  Vec3 shift = Vec3::Zero();      // m

  // A negative zero is never among the results: nobody wants to read "-0".
  Vec3 point(const Vec3& p) const { return (linear * p + shift).array() + 0.0; }
  Vec3 vector(const Vec3& v) const { return (linear * v).array() + 0.0; }
  // Of a rotation, an angular velocity or a torque, whose sense a reflection turns round.
  Vec3 axial(const Vec3& v) const { return (sense() * (linear * v)).array() + 0.0; }
  // -1 for a reflection.
  double sense() const { return linear.determinant() < 0 ? -1 : 1; }
};

Isometry translation(const Vec3& by);
// Nothing where a number is not finite or the direction is none.
std::optional<Isometry> rotation_about(const Vec3& point, const Quat& rotation);
std::optional<Isometry> rotation_about(const Vec3& point, const Vec3& axis, double angle); // rad
std::optional<Isometry> reflection(const Vec3& point, const Vec3& normal);

// A number of about 1 without the round-off of quarter and third turns: 0, a half or 1 where it all but is.
double without_round_off(double x);

} // namespace flyball
