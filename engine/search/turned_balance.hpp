// The balance of steady states that stand turned (phase_search.hpp), linearised with the angles of what turns
// among its unknowns: x steps of coordinates, a angles along V, mu multipliers,
//
//   [ K      F_a      A^T R ] [ x  ]     forces
//   [ R^T J  R^T L_a  0     ] [ a  ]     loops
//   [ M      0        0     ] [ mu ]     ties, over the fastest speed
//
// K, J: of forces and loops by coordinates; F_a, L_a: by the angles; A: the gradients of the loops with all
// that moves free to (kkt/tied_angles.hpp), R an orthonormal basis of their range: loops may be redundant.
// All is scaled, forces over their size, so that the matrix is regular where the state is.
#pragma once

#include "engine/search/phase_search.hpp"

namespace flyball {

class TurnedBalance {
 public:
  // At a state whose angles `problem` has, of `mechanism`; with its multipliers. What is passed must outlive
  // this. The balance is left evaluated in the workspace.
  TurnedBalance(const Problem& problem, const Unknowns& z, const AngleTies& ties, const Mechanism& mechanism,
                Workspace& w);

  // Whether something turns, and all entries are finite.
  bool usable() const { return usable_; }
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  Eigen::Index angles() const { return ties_.along.cols(); }
  Eigen::Index multipliers() const { return range_.cols(); }
  // What is left of the equations without multipliers.
  const Eigen::VectorXd& left() const { return left_; }
  // The same of forces and loops that are known better (not scaled).
  Eigen::VectorXd left_of(const Eigen::VectorXd& force, const Eigen::VectorXd& phi) const;
  // The largest entry that is left with the state's multipliers.
  double residual() const { return residual_; }
  // Of the equations, by a number with these rates, per its unit. Throws InfiniteRate.
  Eigen::VectorXd rate(const NumberRates& numbers) const;
  // In N, N m.
  Eigen::VectorXd lambda_of(const Eigen::VectorXd& mu) const;

 private:
  Problem problem_;
  const Unknowns& z_;
  const AngleTies& ties_;
  const Mechanism& mechanism_;
  double size_ = 1, fastest_ = 0;
  bool usable_ = false;
  Eigen::MatrixXd range_; // R
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd left_;
  double residual_ = 0;
};

} // namespace flyball
