// The balance's Jacobian on the null space of the constraints, factored: by Cholesky where it is symmetric
// and positive definite (then the state is a strict minimum), else by what still works.
#pragma once

#include "engine/linear/spectral.hpp"

namespace flyball {

class ReducedHessian {
 public:
  // Equilibrated by its own diagonal. Symmetric matrices are averaged with their transposes. `noise[i]` is
  // the size below which entry (i, i) is rounding.
  void factor(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& noise, bool symmetric);

  // Directions without stiffness get no component.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);

  // False where an entry overflowed or the matrix could not be decomposed: then it counts as zero.
  bool known() const { return known_; }
  int size() const { return static_cast<int>(scale_.size()); }
  // Symmetric: every eigenvalue well above zero.
  bool positive_definite() const { return positive_; }
  bool singular() const { return null_count() > 0; }
  int null_count() const { return null_; }
  // Symmetric and not positive definite: eigenvalues (ascending) and vectors of the equilibrated matrix;
  // a direction of the original is scale() * vector.
  const Eigen::VectorXd& eigenvalues() const { return eigen_.values(); }
  const Eigen::MatrixXd& eigenvectors() const { return eigen_.vectors(); }
  // Computes them for a positive definite matrix, too; false where they are not found. Of size 0 there are
  // none.
  [[nodiscard]] bool decompose();
  const Eigen::VectorXd& scale() const { return scale_; }
  const Eigen::MatrixXd& equilibrated() const { return matrix_; }
  // Of the equilibrated matrix; none where they are not found.
  Eigen::VectorXd singular_values() const;
  // 2-norm, of the equilibrated matrix where it has stiffness; 1 where that is not found, or of size 0.
  double condition() const;
  // Basis of the directions without stiffness, in the original's coordinates.
  Eigen::MatrixXd null_basis() const;

  static constexpr double zero = 1e-11; // of the equilibrated matrix

 private:
  bool known_ = true, symmetric_ = true, positive_ = false, decomposed_ = false;
  int null_ = 0;
  Eigen::VectorXd scale_, work_;
  Eigen::MatrixXd matrix_;
  Cholesky cholesky_;
  SymmetricEigen eigen_;
  // Not symmetric, of many coordinates and far from singular: a third of the work.
  bool by_lu_ = false;
  Lu lu_;
  CompleteOrthogonal orthogonal_;
};

// A mixture of directions, one a column, with arbitrary shares; its largest entry is 1. What a polynomial in
// the shares does not do along it, it does not do along any of them. Of few directions each is looked at.
constexpr Eigen::Index few_null_directions = 3;
Eigen::VectorXd mixture_of(const Eigen::MatrixXd& directions);

} // namespace flyball
