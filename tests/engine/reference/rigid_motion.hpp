// Placement of a rigid body with its first two time derivatives, as homogeneous 4x4 matrices.
//
// Every part of the reference works in long double and follows one of two kinds of motion at t = 0: the
// motion of a single coordinate at unit rate (a column of B, eq. 4) or of all drives at their speeds
// (whose second derivative is Bdot_D q_D', eq. 20). Products and inverses carry the derivatives by the
// product rule, so nothing is differentiated numerically.
#pragma once

#include <Eigen/Dense>

namespace flyball::reference {

using Real = long double;
using Vec3R = Eigen::Matrix<Real, 3, 1>;
using Mat3R = Eigen::Matrix<Real, 3, 3>;
using Mat4R = Eigen::Matrix<Real, 4, 4>;
using VectorR = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using MatrixR = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using QuatR = Eigen::Quaternion<Real>;

// The matrix with cross(a) * b = a x b.
Mat3R cross(const Vec3R& a);
// Rotation matrix of a rotation vector (rad), and back with an angle in [0, pi].
Mat3R rotation_exp(const Vec3R& r);
Vec3R rotation_log(const Mat3R& rotation);
// r' = left_jacobian_inverse(r) w where exp(r) turns with angular velocity w, both in the axes of r.
Mat3R left_jacobian_inverse(const Vec3R& r);

struct RigidMotion {
  Mat4R x = Mat4R::Identity(), x1 = Mat4R::Zero(), x2 = Mat4R::Zero(); // value, 1/s, 1/s^2

  Mat3R rotation() const { return x.topLeftCorner<3, 3>(); }
  Vec3R angular_velocity() const;
  Vec3R angular_acceleration() const;
  RigidMotion inverse() const;
};

RigidMotion operator*(const RigidMotion& a, const RigidMotion& b);

// Shift by `offset` along a direction fixed at the left, moving at `velocity`.
RigidMotion translation(const Vec3R& offset, const Vec3R& velocity);
// Rotation about the unit `axis` through the origin, at `rate` rad/s.
RigidMotion rotation(const Vec3R& axis, Real angle, Real rate);
// A constant rotation.
RigidMotion rotation(const Mat3R& matrix);
// `motion` of rotation done about the point `at` in place of the origin.
RigidMotion about(const Vec3R& at, const RigidMotion& motion);

// A number or vector with its rate along the motion.
struct MovingReal {
  Real x = 0, v = 0;
};
struct MovingVector {
  Vec3R x = Vec3R::Zero(), v = Vec3R::Zero();
};

// A point or a direction fixed in the body that moves so.
MovingVector moving_point(const RigidMotion& motion, const Vec3R& point);
MovingVector moving_direction(const RigidMotion& motion, const Vec3R& direction);

MovingVector operator-(const MovingVector& a, const MovingVector& b);
MovingReal operator-(const MovingReal& a, const MovingReal& b);
MovingReal operator*(Real k, const MovingReal& a);
MovingReal dot(const MovingVector& a, const MovingVector& b);
MovingReal norm(const MovingVector& a);
MovingReal atan2(const MovingReal& y, const MovingReal& x);

} // namespace flyball::reference
