#include "engine/linear/spectral.hpp"

#include "engine/linear/large.hpp"

namespace flyball {

bool Cholesky::compute(const Eigen::MatrixXd& a) {
  large_ = a.rows() >= large::from;
  if (large_) {
    lower_ = a;
    return large::factor_cholesky(lower_);
  }
  factors_.compute(a);
  // Of NaN the comparison inside tells nothing.
  return factors_.info() == Eigen::Success &&
         (a.rows() == 0 || std::isfinite(factors_.matrixLLT().diagonal().sum()));
}

void Cholesky::solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const {
  if (!large_) {
    factors_.solveInPlace(x);
    return;
  }
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  if (b.size() == 0) return b; // of which Eigen would take the first entry
  if (!large_) return factors_.solve(b);
  Eigen::MatrixXd x = b;
  for (auto column : x.colwise()) {
    interruption_point();
    lower_.triangularView<Eigen::Lower>().solveInPlace(column);
    lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(column);
  }
  return x;
}

Eigen::MatrixXd Cholesky::forward(const Eigen::MatrixXd& b) const {
  if (b.size() == 0) return b;
  if (!large_) return factors_.matrixL().solve(b);
  Eigen::MatrixXd x = b;
  constexpr Eigen::Index some = 8; // columns
  for (Eigen::Index j = 0; j < x.cols(); j += some) {
    interruption_point();
    auto columns = x.middleCols(j, std::min(some, x.cols() - j));
    lower_.triangularView<Eigen::Lower>().solveInPlace(columns);
  }
  return x;
}

double Cholesky::smallest_pivot() const {
  return (large_ ? lower_ : factors_.matrixLLT()).diagonal().cwiseAbs2().minCoeff();
}

} // namespace flyball
