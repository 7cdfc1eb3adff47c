// The wrenches that joints transmit, all forces and constraint forces included.
#pragma once

#include "engine/system/residual.hpp"

namespace flyball {

// World axes.
struct JointWrench {
  Vec3 force = Vec3::Zero();  // N
  Vec3 torque = Vec3::Zero(); // N m, about `point`
  Vec3 point = Vec3::Zero();  // m, the joint's `at` as carried by the child
};

struct TransmittedForces {
  // On a joint's child by its parent: springs, stops, dampers and drives of the joint included.
  std::vector<JointWrench> tree; // by System::tree_joints
  std::vector<JointWrench> cuts; // by System::cuts; zero for gears
  // By the motor, positive along its coordinate, gears' loads included: N m or N, by System::drives; zero for
  // coordinates driven through gears.
  std::vector<double> drives;
};

// `kinematics` and `residual` must be at the same state.
TransmittedForces transmitted_forces(const System& system, const Parameters& parameters,
                                     const Eigen::VectorXd& lambda, const Kinematics<double>& kinematics,
                                     const Residual<double>& residual);

} // namespace flyball
