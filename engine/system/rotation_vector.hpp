// Rotation vectors: the coordinates of spherical joints. With R = exp([r]):
// R exp([d]) and exp([d]) R have rotation vectors r + J_r^-1(r) d and r + J_l^-1(r) d to first order
// (Sola, Deray, Atchuthan, A micro Lie theory, 2018, eqs. 143-146).
#pragma once

#include "engine/system/spatial.hpp"

#include <array>

namespace flyball {

// Unit quaternion (w >= 0 not required) to rotation vector of length at most pi.
template <class S>
Vec3T<S> log_rotation(const Eigen::Quaternion<S>& q) {
  using std::atan2;
  const S sign = q.w() < 0 ? S(-1) : S(1);
  const Vec3T<S> v = sign * q.vec();
  const S n = v.norm(), w = sign * q.w();
  if (n < S(1e-9)) return v * (2 / w * (1 - n * n / (3 * w * w)));
  return v * (2 * atan2(n, w) / n);
}

template <class S>
Eigen::Quaternion<S> exp_rotation(const Vec3T<S>& r) {
  using std::cos;
  using std::sin;
  const S n = r.norm();
  const S k = n < S(1e-6) ? S(0.5) - n * n / 48 : sin(n / 2) / n;
  Eigen::Quaternion<S> q;
  q.w() = cos(n / 2);
  q.vec() = k * r;
  return q;
}

// The coefficient b of J_l^-1 = I - [r]/2 + b [r]^2, and b'(n)/n, n = |r|.
template <class S>
struct InverseJacobianCoefficients {
  S b, db_over_n;
  explicit InverseJacobianCoefficients(S n) {
    using std::sin;
    using std::tan;
    const S x = n / 2;
    if (n < S(0.25)) { // b = (1 - x cot x) / (4 x^2), by its series, to 113 bits
      const S y = x * x;
      const std::array<S, 13> coefficients{S(1) / 12,
                                           S(1) / 180,
                                           S(1) / 1890,
                                           S(1) / 18900,
                                           S(1) / 187110,
                                           S(691) / S(1277025750),
                                           S(1) / 18243225,
                                           5.5536521974949195e-9, // from here on the first digits are enough
                                           5.626961629202249e-10,
                                           5.701287801148046e-11,
                                           5.776608149750656e-12,
                                           5.852926704956221e-13,
                                           5.930254350058413e-14};
      S slope = 0; // db/dy
      b = 0;
      for (std::size_t i = coefficients.size(); i-- > 0;) {
        slope = b + y * slope;
        b = coefficients[i] + y * b;
      }
      db_over_n = slope / 2; // (db/dy) (dy/dn) / n
    } else {
      const S cot = 1 / tan(x), s = sin(x);
      b = 1 / (n * n) - cot / (2 * n);
      db_over_n = (-2 / (n * n * n) + cot / (2 * n * n) + 1 / (4 * n * s * s)) / n;
    }
  }
};

// J_l^-1(r); J_r^-1(r) = J_l^-1(-r) = J_l^-1(r)^T.
template <class S>
Mat3T<S> inverse_left_jacobian(const Vec3T<S>& r) {
  const InverseJacobianCoefficients<S> c(r.norm());
  const Mat3T<S> k = skew<S>(r);
  return Mat3T<S>::Identity() - S(0.5) * k + c.b * (k * k);
}

// Derivative of J_l^-1(r) along d.
template <class S>
Mat3T<S> inverse_left_jacobian_derivative(const Vec3T<S>& r, const Vec3T<S>& d) {
  const InverseJacobianCoefficients<S> c(r.norm());
  const Mat3T<S> k = skew<S>(r), kd = skew<S>(d);
  return S(-0.5) * kd + (c.db_over_n * r.dot(d)) * (k * k) + c.b * (kd * k + k * kd);
}

} // namespace flyball
