#include "tests/engine/reference/rigid_motion.hpp"

#include <cmath>

namespace flyball::reference {

namespace {

Vec3R vee(const Mat3R& skew) {
  return Vec3R(skew(2, 1) - skew(1, 2), skew(0, 2) - skew(2, 0), skew(1, 0) - skew(0, 1)) / 2;
}

} // namespace

Mat3R cross(const Vec3R& a) {
  Mat3R m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Mat3R rotation_exp(const Vec3R& r) {
  const Real angle = r.norm();
  if (angle == 0) return Mat3R::Identity();
  return rotation(r / angle, angle, 0).rotation();
}

Vec3R rotation_log(const Mat3R& rotation) {
  QuatR q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Real sine = q.vec().norm();
  if (sine == 0) return Vec3R::Zero();
  return q.vec() * (2 * std::atan2(sine, q.w()) / sine);
}

Mat3R left_jacobian_inverse(const Vec3R& r) {
  const Real angle = r.norm(), half = angle / 2;
  // (1 - half cot half) / angle^2, whose closed form cancels near zero.
  const Real k =
      angle < 1e-3L ? (1 + angle * angle / 60) / 12 : (1 - half / std::tan(half)) / (angle * angle);
  const Mat3R c = cross(r);
  return Mat3R::Identity() - c / 2 + k * c * c;
}

Vec3R RigidMotion::angular_velocity() const {
  const Mat3R spin = x1.topLeftCorner<3, 3>() * rotation().transpose();
  return vee(spin);
}

Vec3R RigidMotion::angular_acceleration() const {
  // d/dt (R' R^T); its second term R' R'^T is symmetric and drops out of vee.
  const Mat3R change = x2.topLeftCorner<3, 3>() * rotation().transpose();
  return vee(change);
}

RigidMotion RigidMotion::inverse() const {
  const auto invert = [](const Mat4R& m) {
    Mat4R i = Mat4R::Identity();
    i.topLeftCorner<3, 3>() = m.topLeftCorner<3, 3>().transpose();
    i.topRightCorner<3, 1>() = -m.topLeftCorner<3, 3>().transpose() * m.topRightCorner<3, 1>();
    return i;
  };
  RigidMotion r;
  r.x = invert(x);
  r.x1 = -r.x * x1 * r.x;
  r.x2 = -r.x * x2 * r.x - r.x1 * x1 * r.x - r.x * x1 * r.x1;
  return r;
}

RigidMotion operator*(const RigidMotion& a, const RigidMotion& b) {
  RigidMotion r;
  r.x = a.x * b.x;
  r.x1 = a.x1 * b.x + a.x * b.x1;
  r.x2 = a.x2 * b.x + 2 * a.x1 * b.x1 + a.x * b.x2;
  return r;
}

RigidMotion translation(const Vec3R& offset, const Vec3R& velocity) {
  RigidMotion r;
  r.x.topRightCorner<3, 1>() = offset;
  r.x1.topRightCorner<3, 1>() = velocity;
  return r;
}

RigidMotion rotation(const Vec3R& axis, Real angle, Real rate) {
  const Mat3R c = cross(axis);
  const Mat3R m = Mat3R::Identity() + std::sin(angle) * c + (1 - std::cos(angle)) * c * c;
  RigidMotion r;
  r.x.topLeftCorner<3, 3>() = m;
  r.x1.topLeftCorner<3, 3>() = rate * c * m;
  r.x2.topLeftCorner<3, 3>() = rate * rate * c * c * m;
  return r;
}

RigidMotion rotation(const Mat3R& matrix) {
  RigidMotion r;
  r.x.topLeftCorner<3, 3>() = matrix;
  return r;
}

RigidMotion about(const Vec3R& at, const RigidMotion& motion) {
  return translation(at, Vec3R::Zero()) * motion * translation(-at, Vec3R::Zero());
}

MovingVector moving_point(const RigidMotion& motion, const Vec3R& point) {
  const Eigen::Matrix<Real, 4, 1> p = point.homogeneous();
  return {(motion.x * p).head<3>(), (motion.x1 * p).head<3>()};
}

MovingVector moving_direction(const RigidMotion& motion, const Vec3R& direction) {
  return {motion.x.topLeftCorner<3, 3>() * direction, motion.x1.topLeftCorner<3, 3>() * direction};
}

MovingVector operator-(const MovingVector& a, const MovingVector& b) {
  return {a.x - b.x, a.v - b.v};
}
MovingReal operator-(const MovingReal& a, const MovingReal& b) {
  return {a.x - b.x, a.v - b.v};
}
MovingReal operator*(Real k, const MovingReal& a) {
  return {k * a.x, k * a.v};
}

MovingReal dot(const MovingVector& a, const MovingVector& b) {
  return {a.x.dot(b.x), a.v.dot(b.x) + a.x.dot(b.v)};
}

MovingReal norm(const MovingVector& a) {
  const Real length = a.x.norm();
  return {length, a.x.dot(a.v) / length};
}

MovingReal atan2(const MovingReal& y, const MovingReal& x) {
  return {std::atan2(y.x, x.x), (x.x * y.v - y.x * x.v) / (x.x * x.x + y.x * y.x)};
}

} // namespace flyball::reference
