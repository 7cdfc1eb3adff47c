// The bordered balance of large mechanisms, in time that grows with the bodies (bordered_kkt.hpp).
//
// The sign of B's determinant is that of A, by its inertia (Sylvester), times that of the border's
// complement. Of problems with a potential.
#pragma once

#include "engine/continuation/bordered_balance.hpp"
#include "engine/continuation/bordered_kkt.hpp"

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
  // What inverse iteration on the null space of the constraints makes of any start: near the eigenvector of
  // least eigenvalue; `rate` is about the size of that, forces measured by force_size(). False where B is
  // singular altogether. With the border set.
  bool iterate_inversely(int iterations, BorderedKkt::Vector& v, double& rate);

  void set_row(const Eigen::VectorXd& row);

  int n_ = 0;
  BorderedKkt bordered_;
  Eigen::VectorXd force_, loops_; // of the balance, scaled, with multipliers
  Eigen::VectorXd old_lambda_;    // scaled
};

} // namespace flyball
