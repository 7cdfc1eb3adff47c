// What of a motion has left where the mechanism means anything.
#pragma once

#include "engine/dynamics/equations.hpp"

#include <string>
#include <vector>

namespace flyball {

// The coordinate furthest beyond what any mechanism could reach, in place or rate, as a clause; empty as a
// rule. `rate_scale` (1/s): how fast a coordinate that moves through a radian or the reach is as a rule.
std::string runaway_coordinate(const MotionModel& model, const Eigen::VectorXd& state, double rate_scale);

// Rotation vectors (rad) between the bodies of bearings that resist turns, from step to step.
class BearingTurns {
 public:
  void forget() { turns_.clear(); }
  // The bearing whose rotation vector went over half a turn since the last step, where its moments jump, as a
  // clause; empty as a rule.
  std::string turned_over(const MotionModel& model, const Kinematics<double>& now);

 private:
  std::vector<Vec3> turns_;
};

} // namespace flyball
