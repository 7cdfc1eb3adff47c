// The bordered balance of states that stand turned: the angles of what turns are among the unknowns
// (search/turned_balance.hpp), so that a step or direction is [x; a; m].
#pragma once

#include "engine/continuation/bordered_balance.hpp"
#include "engine/search/turned_balance.hpp"

namespace flyball {

// Of a family whose angles are tied.
class TurnedBorders final : public BorderedBalance {
 public:
  TurnedBorders(Family& family, Workspace& w) : BorderedBalance(family, w) {}

  double linearize(const Unknowns& z, double parameter) override;
  bool step(const Eigen::VectorXd& border, double along, Eigen::VectorXd& step,
            Eigen::VectorXd& lambda) override;
  bool direction(const Eigen::VectorXd& border, Eigen::VectorXd& out) override;
  std::optional<double> determinant(const Eigen::VectorXd& border) override;
  bool second_direction(const Eigen::VectorXd& tangent, Eigen::VectorXd& out) override;

 private:
  // By coordinates, angles, multipliers and the parameter, in that order.
  Eigen::MatrixXd bordered(const Eigen::VectorXd& border) const;
  // Without the multipliers.
  Eigen::VectorXd direction_of(const Eigen::VectorXd& all) const;

  Unknowns z_;
  std::optional<TurnedBalance> balance_; // at z_
  Eigen::VectorXd rate_;                 // of its equations in the parameter
};

} // namespace flyball
