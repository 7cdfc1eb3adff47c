// The bordered balance of large mechanisms, in time that grows with the bodies: by block elimination with the
// factors of the KKT matrix A and refinement, which is right where A itself is nearly singular, too (Govaerts
// and Pryce, Block elimination with one refinement solves bordered linear systems accurately, 1990),
//   A w = b, A u = f, m = (g - t_x . u) / delta, delta = t_p - t_x . w, [x; lambda] = u - m w.
// Where a direction of A has no stiffness but for rounding, the factors are those of A + shift W with the
// metric W: B with that shift is as near to B as the shift is small, and refinement leads to the solution of
// B itself.
//
// The sign of B's determinant is that of A, by its inertia (Sylvester), times that of delta. Of problems with
// a potential.
#pragma once

#include "engine/continuation/bordered_balance.hpp"
#include "engine/kkt/motion_products.hpp"

namespace flyball {

class KktBorders final : public BorderedBalance {
 public:
  KktBorders(Family& family, Workspace& w) : BorderedBalance(family, w) {}

  double linearize(const Unknowns& z, double parameter) override;
  bool step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
            Eigen::VectorXd& lambda) override;
  bool direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) override;
  std::optional<double> determinant(const Eigen::VectorXd& border) override;
  bool second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) override;

 private:
  // Of a right-hand side or solution of B.
  struct Bordered {
    Eigen::VectorXd x, lambda; // n, rows; in forces and loops
    double m = 0;
  };

  KktSystem& factors() { return w_.kkt(family_.problem()); }
  double delta(const Eigen::VectorXd& border) const;
  // By block elimination alone.
  bool eliminate(const Eigen::VectorXd& border, const Bordered& rhs, Bordered& out);
  // With refinement. False where what is left is more than rounding.
  bool solve(const Eigen::VectorXd& border, const Bordered& rhs, Bordered& out);
  // rhs - B v, and its size beside the terms that forces and border are made of.
  double residual(const Eigen::VectorXd& border, const Bordered& rhs, const Bordered& v, Bordered& out);
  // What inverse iteration on the null space of the constraints makes of any start: near the eigenvector of
  // least eigenvalue; `rate` is about the size of that, forces measured by force_size_. False where B is
  // singular altogether.
  bool iterate_inversely(const Eigen::VectorXd& border, int iterations, Bordered& v, double& rate);
  double force_size();

  int n_ = 0;
  double force_size_ = 1; // of the loads, scaled
  MotionProducts products_;
  Eigen::VectorXd force_, loops_;                  // of the balance, scaled, with multipliers
  Eigen::VectorXd old_lambda_;                     // scaled
  Eigen::VectorXd rate_step_, rate_multipliers_;   // w
  Eigen::VectorXd product_, constrained_, closed_; // K x, J^T lambda, J x
};

} // namespace flyball
