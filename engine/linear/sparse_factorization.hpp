// The sparse KKT matrix [K, J^T; J, 0] of a mechanism (or any sparse matrix), with the signs of its
// eigenvalues (Sylvester) and what it maps to zero but for rounding.
//
// What is factored is [K + rho J^T J, J^T; J, 0]: it has the same solutions and the same inertia (the two are
// congruent), and its first block is positive definite altogether where K is so on the null space of J, if
// rho is large enough (Nocedal and Wright, Numerical Optimization, 2006, section 17.3; Benzi, Golub, Liesen,
// Numerical solution of saddle point problems, 2005, section 8.4). So its pivots can be single ones.
#pragma once

#include "engine/linear/sparse_pattern.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace flyball {

class SparseFactorization {
 public:
  SparseFactorization();
  ~SparseFactorization();
  SparseFactorization(SparseFactorization&&) noexcept;
  SparseFactorization& operator=(SparseFactorization&&) noexcept;

  // Pivots below `zero` times the matrix (after its rows and columns are equilibrated) count as zero. The
  // order of elimination is kept as long as the pattern stays, and the factors as long as the values do, too.
  void factor(const SparsePattern& pattern, const std::vector<double>& values, double zero);

  // In place, with corrections until it holds to `enough` of its terms. Zero pivots get no component.
  void solve(Eigen::VectorXd& x, double enough);

  int negative() const; // pivots; of a symmetric matrix
  int nullity() const;
  // A basis of what is mapped to zero: (size, nullity).
  const Eigen::MatrixXd& null_space();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
