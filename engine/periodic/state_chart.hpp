// Coordinates of the states of a motion near one of them. Loops let its coordinates and rates move on a
// manifold only: here are as many numbers as it has dimensions.
#pragma once

#include "engine/periodic/flow.hpp"

namespace flyball {

// What angles of drives by torque need not return, as scaled changes of the coordinates (nv), by column.
struct AlikeAngles {
  Eigen::MatrixXd anywhere{}; // directions: the motion goes on alike wherever along these it stands
  // A turn of a drive with what gears and belts carry round, after which it goes on alike although these did
  // not turn whole times; and the entries of the drives.
  Eigen::MatrixXd turns{};
  std::vector<Eigen::Index> drives{};
};

class StateChart {
 public:
  // About a state whose loops are closed. `rate` (1/s) is the unit of rates, as Scaling has those of the
  // coordinates. Directions along which motions go alike are left out: their rates stay.
  StateChart(const Problem& problem, FlowState base, double rate, const AlikeAngles& alike);

  const FlowState& base() const { return base_; }
  // Of the coordinates, and of those and their rates together.
  Eigen::Index positions() const { return places_.cols(); }
  Eigen::Index size() const { return places_.cols() + rates_.cols(); }

  // The base moved by a vector of this size; loops are then open by its square.
  FlowState displaced(const Eigen::VectorXd& x) const;
  // The coordinates of a state, angles that nothing springs back by the short way round.
  Eigen::VectorXd coordinates(const FlowState& state) const;
  // How far a state is away, by the coordinate or rate that is furthest: scaled.
  double distance(const FlowState& state) const;
  // A vector of this size as changes of the coordinates (rad, m) and rates.
  Eigen::VectorXd place_change(const Eigen::VectorXd& x) const;

 private:
  // Of the coordinates, scaled, from the base moved along what is left out as far as the state went.
  Eigen::VectorXd away(const FlowState& state) const;
  Problem problem() const { return {*system_, *parameters_, *scaling_}; }

  const System* system_;
  const Parameters* parameters_;
  const Scaling* scaling_;
  FlowState base_;
  double rate_;
  Eigen::MatrixXd places_, rates_; // (nv, any), orthonormal, scaled
  Eigen::MatrixXd left_out_;       // (nv, any), orthonormal
  Eigen::MatrixXd turns_;
  std::vector<Eigen::Index> turning_; // as AlikeAngles has both
};

} // namespace flyball
