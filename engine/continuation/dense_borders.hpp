// The bordered balance by dense matrices: with N spanning the null space of the constraints and x = N y + r0
// + r1 m these are kept to first order whatever y and m are, redundant ones too, and the balance is then H y
// + b m = -g.
#pragma once

#include "engine/continuation/bordered_balance.hpp"

namespace flyball {

class DenseBorders final : public BorderedBalance {
 public:
  DenseBorders(Family& family, Workspace& w) : BorderedBalance(family, w) {}

  double linearize(const Unknowns& z, double parameter) override;
  void keep_still(const Eigen::MatrixXd& directions) override;
  Eigen::MatrixXd keep_still_there() override;
  Eigen::MatrixXd keep_null_space_still(const Eigen::VectorXd& along) override;
  bool hardly_resists() const override { return hardly_resists_; }
  bool step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
            Eigen::VectorXd& lambda) override;
  bool direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) override;
  std::optional<double> determinant(const Eigen::VectorXd& border) override;
  int falling() override;
  bool second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) override;

 private:
  Eigen::MatrixXd bordered(const Eigen::VectorXd& border) const;
  // From here on, instead of what was.
  Eigen::MatrixXd keep_still_reduced(const Eigen::MatrixXd& directions);
  // How many of the singular values of H, descending, are zero but for rounding.
  Eigen::Index unresisted(const Eigen::VectorXd& values);
  Eigen::VectorXd expand(const Eigen::VectorXd& reduced, double with_r0) const;

  Eigen::MatrixXd basis_;   // N
  Eigen::VectorXd r0_, r1_; // range parts: closing the loops, following the parameter
  Eigen::MatrixXd h_;       // [H b]: (k, k + 1); with what keeps still
  Eigen::MatrixXd still_;   // N^T V: (k, d)
  bool hardly_resists_ = false;
  Eigen::VectorXd g_;
  Eigen::VectorXd force_; // scaled, without multipliers
};

} // namespace flyball
