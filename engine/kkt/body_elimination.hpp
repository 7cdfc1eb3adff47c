// Solves the sparse equations of the bodies (body_equations.hpp).
//
// Factored as L D L^T with pivoting; in a plane net of n bodies that takes about n log n of storage and n^1.5
// of work (George, Nested dissection of a regular finite element mesh, 1973). The signs of its eigenvalues
// less those of the multipliers are those of the Hessian that the constraints leave (Nocedal and Wright,
// Numerical Optimization, 2006, theorem 16.3).
#pragma once

#include "engine/kkt/body_equations.hpp"
#include "engine/kkt/eliminator.hpp"
#include "engine/linear/sparse_factorization.hpp"

namespace flyball {

class BodyElimination final : public Eliminator {
 public:
  // Of a system with no_drive_rides().
  void linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                 const Residual<double>& residual, const Magnitudes& magnitudes) override;
  bool linearize_convex(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                        const Residual<double>& residual, const Magnitudes& magnitudes) override;
  // Takes in the metric alone, as a stiffness: then a step is the shortest one that closes the loops, and
  // multipliers are those that balance a force best. Dependent rows have pivots of the size by which the
  // loops are open, told by `tolerance`.
  void linearize_metric(const Problem& problem, const Kinematics<double>& kinematics, double tolerance);

  void factor(double shift = 0) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  void direction_of(const Flat& flat, Eigen::VectorXd& x) override;

  // Constraint rows that others imply, of the last factor().
  int redundant() const { return redundant_; }

 private:
  void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                Eigen::VectorXd& lambda) override;
  void take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
               const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines);
  void start(double tolerance, bool metric_alone);
  void set_loose_directions();
  void add_flat_directions();

  BodyEquations equations_;
  SparseFactorization factors_, constraints_;
  bool metric_alone_ = false;
  int redundant_ = 0;
  double tolerance_ = zero;
  Eigen::VectorXd held_;
  std::vector<Vec6> motion_, wrench_; // by node
};

} // namespace flyball
