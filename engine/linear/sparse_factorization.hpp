// A sparse matrix factored with pivoting as L D L^T or L U, by MUMPS (Amestoy, Duff, L'Excellent, Koster, A
// fully asynchronous multifrontal solver using distributed dynamic scheduling, 2001). Tells the signs of the
// eigenvalues (Sylvester) and what the matrix maps to zero but for rounding. Each thread may have its own;
// they take turns.
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
  // False where memory runs out.
  bool factor(const SparsePattern& pattern, const std::vector<double>& values, double zero);

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
