#include "engine/linear/exponential.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace flyball {

std::optional<Eigen::MatrixXd> matrix_exponential(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.rows() == 0) return a;
  Eigen::MatrixXd out = a.exp();
  if (!out.allFinite()) return {};
  return out;
}

} // namespace flyball
