// Small vector algebra shared by the system's passes. Spatial vectors are kept as two 3-vectors, angular
// part first, referred to a stated point and always in world axes (Featherstone, Rigid Body Dynamics
// Algorithms, 2008, chapter 2, without its coordinate rotations).
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace flyball {

template <class S>
using Vec3T = Eigen::Matrix<S, 3, 1>;
template <class S>
using Mat3T = Eigen::Matrix<S, 3, 3>;

// [a] with [a] b = a x b.
template <class S>
Mat3T<S> skew(const Vec3T<S>& a) {
  Mat3T<S> m;
  m << S(0), -a.z(), a.y(), a.z(), S(0), -a.x(), -a.y(), a.x(), S(0);
  return m;
}

// [a] [b].
inline Mat3 skew_product(const Vec3& a, const Vec3& b) {
  Mat3 m;
  m.noalias() = b * a.transpose();
  m.diagonal().array() -= a.dot(b);
  return m;
}

// [a] m, and m [a].
inline Mat3 skew_times(const Vec3& a, const Mat3& m) {
  Mat3 x;
  for (int j = 0; j < 3; ++j) {
    x(0, j) = a.y() * m(2, j) - a.z() * m(1, j);
    x(1, j) = a.z() * m(0, j) - a.x() * m(2, j);
    x(2, j) = a.x() * m(1, j) - a.y() * m(0, j);
  }
  return x;
}
inline Mat3 times_skew(const Mat3& m, const Vec3& a) {
  Mat3 x;
  x.col(0) = a.z() * m.col(1) - a.y() * m.col(2);
  x.col(1) = a.x() * m.col(2) - a.z() * m.col(0);
  x.col(2) = a.y() * m.col(0) - a.x() * m.col(1);
  return x;
}

// Rotation by `angle` about the unit vector `a` (Rodrigues), with 1 - cos formed without cancellation.
template <class S>
Mat3T<S> rotation_about(const Vec3T<S>& a, S angle) {
  using std::cos;
  using std::sin;
  const S s = sin(angle), h = sin(angle / 2), versine = 2 * h * h;
  const Vec3T<S> b = versine * a, c = s * a;
  Mat3T<S> m;
  m << 1 - b.y() * a.y() - b.z() * a.z(), b.x() * a.y() - c.z(), b.x() * a.z() + c.y(), b.x() * a.y() + c.z(),
      1 - b.x() * a.x() - b.z() * a.z(), b.y() * a.z() - c.x(), //
      b.x() * a.z() - c.y(), b.y() * a.z() + c.x(), 1 - b.x() * a.x() - b.y() * a.y();
  return m;
}

} // namespace flyball
