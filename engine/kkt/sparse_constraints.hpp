// The constraints of a mechanism of many bodies by themselves: the sparse equations of its bodies with the
// metric for a stiffness. A solution is then the shortest step that closes the loops, or the multipliers that
// balance a force best.
#pragma once

#include "engine/kkt/body_equations.hpp"
#include "engine/linear/sparse_factorization.hpp"

namespace flyball {

// In scaled units. Of a system with no_drive_rides().
class SparseConstraints {
 public:
  // Dependent rows have pivots of the size by which the loops are open, below `tolerance`.
  void factor(const Problem& problem, const Kinematics<double>& kinematics, double tolerance,
              BodyEntries::Zeros zeros = BodyEntries::Zeros::left_out);

  // [W, J^T; J, 0] [x; lambda] = [rhs; closing].
  void solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
             Eigen::VectorXd& lambda);

  int redundant() const { return factors_.nullity(); } // rows that others imply
  double mass() const { return equations_.mass(); }

 private:
  BodyEquations equations_;
  SparseFactorization factors_;
  Eigen::VectorXd reduced_;
};

} // namespace flyball
