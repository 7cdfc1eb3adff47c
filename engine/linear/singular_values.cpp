#include "engine/linear/spectral.hpp"

#include <Eigen/SVD>

namespace flyball {

std::optional<Eigen::VectorXd> singular_values(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.size() == 0) return Eigen::VectorXd(0);
  // One-sided Jacobi is the more accurate one, and too slow for large matrices.
  if (std::min(a.rows(), a.cols()) < 32) return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(a);
  if (svd.info() != Eigen::Success || !svd.singularValues().allFinite()) return {};
  return svd.singularValues();
}

std::optional<SingularVectors> singular_vectors(const Eigen::MatrixXd& a) {
  if (!a.allFinite() || a.size() == 0) return {};
  constexpr unsigned vectors = Eigen::ComputeFullU | Eigen::ComputeFullV;
  const auto result = [](const auto& svd) {
    return SingularVectors{svd.singularValues(), svd.matrixU(), svd.matrixV()};
  };
  if (std::min(a.rows(), a.cols()) < 32) return result(Eigen::JacobiSVD<Eigen::MatrixXd>(a, vectors));
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(a, vectors);
  if (svd.info() != Eigen::Success || !svd.singularValues().allFinite()) return {};
  return result(svd);
}

std::optional<SingularVectors3> singular_vectors_3(const Eigen::Matrix3d& a) {
  if (!a.allFinite()) return {};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return SingularVectors3{svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

} // namespace flyball
