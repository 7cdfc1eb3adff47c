#include "engine/kkt/sparse_constraints.hpp"

namespace flyball {

void SparseConstraints::factor(const Problem& problem, const Kinematics<double>& k, double tolerance,
                               BodyEntries::Zeros zeros) {
  equations_.assemble_metric(problem, k, zeros);
  factors_.factor(equations_.pattern(), equations_.sum(1, 0), tolerance);
}

void SparseConstraints::solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                              Eigen::VectorXd& lambda) {
  constexpr double enough = 1e-11; // of the terms of each equation
  x.setZero(equations_.coordinates());
  lambda.setZero(equations_.rows());
  equations_.assemble_rhs(rhs, closing, reduced_);
  if (reduced_.size() > 0) factors_.solve(reduced_, enough);
  equations_.extract_solution(reduced_, x, lambda);
}

} // namespace flyball
