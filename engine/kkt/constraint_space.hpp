// The range and the null space of the constraint Jacobian, found by column-pivoted Householder QR of its
// transpose. Loops are often redundantly constrained, so the rank is found, not assumed.
#pragma once

#include "engine/linear/spectral.hpp"

namespace flyball {

// Of a row by a radian or the reach (Scaling): all that the rows of a joint have that is there twice.
constexpr double row_rounding = 1e-13;

class ConstraintSpace {
 public:
  // `jacobian` is scaled: (rows, n). Pivots below `tolerance` times the largest, or below `least`, count as
  // zero. Of a Jacobian with an entry that is not finite nothing is known: its rank counts as zero.
  void factor(const Eigen::MatrixXd& jacobian, double tolerance, double least = 0);

  int size() const { return n_; }
  int rows() const { return rows_; }
  int rank() const { return rank_; }
  // The smallest pivot that does not count as zero, beside the largest: about how far away, in scaled
  // coordinates, the loops are from a pose in which one more row depends on the others. 1 where no row
  // counts.
  double least_pivot() const { return rank_ > 0 ? qr_.pivot(rank_ - 1) / qr_.pivot(0) : 1; }
  // Orthonormal basis of the null space: (n, n - rank).
  const Eigen::MatrixXd& basis() const { return basis_; }

  // Of dependent row k, 0 to rows() - rank() - 1: the combination of rows, itself taken once, that vanishes
  // to the tolerance (rows), and what is left of it (n).
  void dependence(int k, Eigen::VectorXd& combination, Eigen::VectorXd& left) const;

  // The shortest y with jacobian y = rhs on the independent rows.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& y) const;
  // A multiplier vector that best fits jacobian^T lambda = rhs, zero on dependent rows; allocation-free.
  void multipliers(const Eigen::VectorXd& rhs, Eigen::VectorXd& lambda) const;
  // The same of least norm.
  Eigen::VectorXd least_norm_multipliers(const Eigen::VectorXd& rhs) const;

 private:
  int n_ = 0, rows_ = 0, rank_ = 0;
  Eigen::MatrixXd transposed_;
  PivotedQr qr_;
  Eigen::MatrixXd basis_;
  mutable Eigen::VectorXd work_;
  Eigen::VectorXd apply_work_;
};

} // namespace flyball
