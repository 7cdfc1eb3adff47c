#include "engine/linear/spectral.hpp"

#include "engine/linear/large.hpp"

namespace flyball {

bool SymmetricEigen::compute(const Eigen::MatrixXd& a, bool with_vectors) {
  if (!a.allFinite()) return false;
  large_ = a.rows() >= large::from;
  if (large_) return large::symmetric_eigen(a, values_, with_vectors ? &vectors_ : nullptr);
  solver_.compute(a, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  return solver_.info() == Eigen::Success;
}

std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  SymmetricEigen eigen;
  if (a.rows() == 0) return Eigen::VectorXd(0);
  if (!eigen.compute(a, false)) return {};
  return eigen.values();
}

std::optional<PrincipalAxes> principal_axes(const Eigen::Matrix3d& a) {
  if (!a.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(a);
  if (eigen.info() != Eigen::Success) return {};
  return PrincipalAxes{eigen.eigenvalues(), eigen.eigenvectors()};
}

} // namespace flyball
