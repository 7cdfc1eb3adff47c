// Whether the balance is singular, as a number g that vanishes where it is: the last unknown of the balance
// bordered by vectors b, c that are near its null vectors (minimally augmented systems; Griewank and Reddien,
// Characterization and computation of generalized turning points, 1984; Govaerts, Numerical Methods for
// Bifurcations of Dynamical Equilibria, 2000, 4.2),
//   [ A    b ] [ v ]   [ 0 ]
//   [ c^T  0 ] [ g ] = [ 1 ],   A the KKT matrix, v = [x; mu].
// With a potential A is the Hessian of the Lagrangian by z = [q; lambda], so b = c, and
//   dg/dy = -v^T (dA/dy) v
// for every y. As third derivatives of the Lagrangian are symmetric, all these together are
//   dg/dz = -(d/ds) A(z + s v) v,
// which takes two states beside z, however many unknowns there are.
//
// All is scaled (Scaling), and A measured by the size of the forces where the borders were set.
#pragma once

#include "engine/kkt/workspace.hpp"

namespace flyball {

class SingularityTest {
 public:
  // At a state that is evaluated in the workspace and, by matrices, factored, as for all that follows: the
  // singular vectors of least singular value; of large matrices by inverse iteration.
  void set_borders(const Problem& problem, const Unknowns& z, Workspace& w);
  const Eigen::VectorXd& left() const { return left_; } // b, by coordinates: (n)

  // g; NaN where the borders do not help.
  double value(const Problem& problem, const Unknowns& z, Workspace& w) const;
  // dg/dq and dg/dlambda. Of a problem with a potential and not by matrices; `w` may be at any state.
  struct Gradient {
    Eigen::VectorXd x, lambda;
  };
  Gradient gradient(const Problem& problem, const Unknowns& z, Workspace& w) const;

  // At a singular state, by matrices: by how much the balance leaves its range as a parameter moves, by the
  // rates of forces and loops in it. Vanishes at a branch point.
  double leaving(const Eigen::VectorXd& force_rate, const Eigen::VectorXd& loop_rate, Workspace& w) const;

 private:
  // On the null space of the constraints.
  Eigen::MatrixXd bordered(const Workspace& w) const;

  Eigen::VectorXd left_, right_;
  double size_ = 1;
};

// Of the loads and the stiffness, by matrices: a state without loads has stiffness only, one without
// stiffness loads only.
double force_size(const Problem& problem, const Workspace& w);

} // namespace flyball
