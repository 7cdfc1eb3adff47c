// What makes forces jump while a mechanism moves, so that the integrator has to stop there: stops that are
// reached or left, and rotation vectors that turn over.
#pragma once

#include "engine/dynamics/motion_model.hpp"

#include <vector>

namespace flyball {

// A rotation vector on which springs or dampers act: their forces jump where it turns over, at half a turn.
// `side` says on which side to take them, by the sign of the rotation's scalar part.
struct FlipElement {
  int link = 0;
  bool side = true;
};
std::vector<FlipElement> list_flips(const System& system, const Parameters& parameters);
// The rotation whose vector the joint's coordinates are, of any length and sign.
Quat joint_rotation(const Link& link, const LinkParameters& parameters, const Eigen::VectorXd& q);
Quat joint_rotation(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q);
// 1/s, of its scalar part.
double flip_rate(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& u);
// J, by which the springs of a rotation vector differ from what they were at the other side of half a turn.
double flip_energy(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q);

// A stop of a free coordinate.
struct StopElement {
  int link = 0, component = 0;
  bool upper = false;
  double limit = 0, stiffness = 0;
};
std::vector<StopElement> list_stops(const System& system, const Parameters& parameters);
// How far (rad, m) a coordinate is above the limit of a stop.
double value_at_stop(const MotionModel& model, const StopElement& stop, const Eigen::VectorXd& q);
// Its rate at velocities u, rad/s or m/s.
double rate_at_stop(const MotionModel& model, const StopElement& stop, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u);

} // namespace flyball
