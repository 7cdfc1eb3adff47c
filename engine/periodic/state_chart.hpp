// Coordinates of the states of a motion near one of them. Loops let its coordinates and rates move on a
// manifold only: here are as many numbers as it has dimensions.
#pragma once

#include "engine/periodic/flow.hpp"

namespace flyball {

class StateChart {
 public:
  // About a state whose loops are closed. `rate` (1/s) is the unit of rates, as Scaling has those of the
  // coordinates. Directions of the coordinates along `without` (nv, any), scaled, are left out: their rates
  // stay.
  StateChart(const Problem& problem, MotionState base, double rate, const Eigen::MatrixXd& without);

  const MotionState& base() const { return base_; }
  // Of the coordinates, and of those and their rates together.
  Eigen::Index positions() const { return places_.cols(); }
  Eigen::Index size() const { return places_.cols() + rates_.cols(); }

  // The base moved by a vector of this size; loops are then open by its square.
  MotionState displaced(const Eigen::VectorXd& x) const;
  // The coordinates of a state, angles that nothing springs back by the short way round.
  Eigen::VectorXd coordinates(const MotionState& state) const;
  // How far a state is away, by the coordinate or rate that is furthest: scaled.
  double distance(const MotionState& state) const;
  // A vector of this size as changes of the coordinates (rad, m) and rates.
  Eigen::VectorXd place_change(const Eigen::VectorXd& x) const;

 private:
  // Of the coordinates, scaled, from the base moved along what is left out as far as the state went.
  Eigen::VectorXd away(const MotionState& state) const;
  Problem problem() const { return {*system_, *parameters_, *scaling_}; }

  const System* system_;
  const Parameters* parameters_;
  const Scaling* scaling_;
  MotionState base_;
  double rate_;
  Eigen::MatrixXd places_, rates_; // (nv, any), orthonormal, scaled
  Eigen::MatrixXd left_out_;       // (nv, any), orthonormal
};

} // namespace flyball
