#include "engine/linear/exponential.hpp"

#include "engine/linear/spectral.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include <numbers>

namespace flyball {

std::optional<Eigen::MatrixXd> matrix_exponential(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.rows() == 0) return a;
  Eigen::MatrixXd out = a.exp();
  if (!out.allFinite()) return {};
  return out;
}

std::optional<Eigen::MatrixXd> rotation_logarithm(const Eigen::MatrixXd& q) {
  if (q.rows() == 0) return q;
  const auto schur = real_schur(q);
  if (!schur) return {};
  // Of a normal matrix T is block diagonal: rotations of a plane, 1, and -1, two of which turn a plane by pi.
  Eigen::MatrixXd angles = Eigen::MatrixXd::Zero(q.rows(), q.cols());
  const auto turn = [&](Eigen::Index a, Eigen::Index b, double by) {
    angles(b, a) = by;
    angles(a, b) = -by;
  };
  const Eigen::MatrixXd& t = schur->t;
  std::optional<Eigen::Index> reversed;
  for (Eigen::Index i = 0; i < t.rows(); ++i) {
    if (i + 1 < t.rows() && t(i + 1, i) != 0) {
      turn(i, i + 1, std::atan2(t(i + 1, i) - t(i, i + 1), t(i, i) + t(i + 1, i + 1)));
      ++i;
    } else if (t(i, i) < 0 && reversed) {
      turn(*reversed, i, std::numbers::pi);
      reversed.reset();
    } else if (t(i, i) < 0) {
      reversed = i;
    }
  }
  if (reversed) return {};
  return Eigen::MatrixXd(schur->u * angles * schur->u.transpose());
}

} // namespace flyball
