#include "app/document/isometry.hpp"

#include <cmath>

namespace flyball {
namespace {

// The isometry that leaves `point` where it is.
std::optional<Isometry> around(const Vec3& point, Mat3 linear) {
  for (double& entry : linear.reshaped())
    entry = without_round_off(entry);
  const Isometry isometry{linear, point - linear * point};
  if (!isometry.linear.allFinite() || !isometry.shift.allFinite()) return {};
  return isometry;
}

} // namespace

double without_round_off(double x) {
  constexpr double round_off = 1e-15;
  const double half = std::round(2 * x) / 2;
  return std::abs(x - half) <= round_off ? half + 0.0 : x;
}

Isometry translation(const Vec3& by) {
  return {Mat3::Identity(), by};
}

std::optional<Isometry> rotation_about(const Vec3& point, const Quat& rotation) {
  const double norm = rotation.coeffs().stableNorm();
  if (!std::isfinite(norm) || !(norm > 0)) return {};
  const Quat unit(Eigen::Vector4d(rotation.coeffs() / norm));
  return around(point, unit.normalized().toRotationMatrix());
}

std::optional<Isometry> rotation_about(const Vec3& point, const Vec3& axis, double angle) {
  const Vec3 direction = axis.stableNormalized();
  if (!std::isfinite(angle) || !direction.allFinite() || direction.isZero(0)) return {};
  return around(point, Eigen::AngleAxisd(angle, direction).toRotationMatrix());
}

std::optional<Isometry> reflection(const Vec3& point, const Vec3& normal) {
  const Vec3 n = normal.stableNormalized();
  if (!n.allFinite() || n.isZero(0)) return {};
  return around(point, Mat3::Identity() - 2 * n * n.transpose());
}

} // namespace flyball
