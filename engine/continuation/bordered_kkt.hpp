// The KKT matrix A bordered by k columns, the rates of forces and loops in parameters, and as many rows,
//   [ A     b  ] [ v ]        v = [x; lambda], b = [f_p; phi_p]: (n + rows, k)
//   [ c     d  ] [ m ]        c, d: the rows, by coordinates and multipliers and by parameters
// solved in time that grows with the bodies: by block elimination with the factors of A and refinement, which
// is right where A itself is nearly singular, too (Govaerts and Pryce, Block elimination with one refinement
// solves bordered linear systems accurately, 1990),
//   A w = b, A u = f, m = (d - c w)^-1 (g - c u), v = u - w m.
// Where a direction of A has no stiffness but for rounding, the factors are those of A + shift W with the
// metric W: what is solved with that shift is as near to the bordered matrix as the shift is small, and
// refinement leads to the solution with the matrix itself.
//
// All is scaled (Scaling; parameters by ranges of interest). Of a system with no_drive_rides().
#pragma once

#include "engine/kkt/motion_products.hpp"
#include "engine/kkt/workspace.hpp"

namespace flyball {

class BorderedKkt {
 public:
  // A right-hand side or a solution.
  struct Vector {
    Eigen::VectorXd x, lambda; // n, rows; in forces and loops
    Eigen::VectorXd m;         // k
  };

  // Linearises and factors the balance at z, where it is evaluated in the workspace.
  void linearize(const Problem& problem, const Unknowns& z, Workspace& w);
  // b, by its parts (n, k) and (rows, k).
  void set_columns(const Eigen::MatrixXd& forces, const Eigen::MatrixXd& loops);
  // [c d] by its parts (k, n), (k, rows) and (k, k).
  struct Rows {
    Eigen::MatrixXd x, lambda, m; // lambda: empty where it is zero
  };
  void set_rows(Rows rows);

  // d - c w: the bordered matrix is singular where this is and A is not.
  const Eigen::MatrixXd& complement() const { return complement_; }
  // By block elimination alone.
  bool eliminate(const Vector& rhs, Vector& out);
  // With refinement. False where what is left is more than rounding.
  bool solve(const Vector& rhs, Vector& out);

  // Of the loads: a state without loads has stiffness only, one without stiffness loads only.
  double force_size() const { return force_size_; }

 private:
  // rhs less the bordered matrix times v, and its size beside the terms that forces and rows are made of.
  double residual(const Vector& rhs, const Vector& v, Vector& out);

  KktSystem* factors_ = nullptr;
  MotionProducts products_;
  double force_size_ = 1;
  // c v.
  Eigen::VectorXd along_rows(const Eigen::VectorXd& x, const Eigen::VectorXd& lambda) const;

  Rows rows_;
  Eigen::MatrixXd force_rates_, loop_rates_, complement_;
  Eigen::MatrixXd steps_, multipliers_;            // w
  Eigen::VectorXd product_, constrained_, closed_; // K x, J^T lambda, J x
};

} // namespace flyball
