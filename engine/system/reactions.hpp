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

// What a gear does along the coordinates of its two joints, on their children, positive along the coordinate.
// The joints transmit it: it is part of their wrenches.
struct GearForces {
  int joint = -1; // in the mechanism
  struct End {
    int link = -1;
    double value = 0; // N m or N
  };
  End a, b; // between driven coordinates: b is the farther from the motor, and both lack a link where the
            // gear has no load because others lead there
};

struct TransmittedForces {
  // On a joint's child by its parent: springs, stops, dampers and drives of the joint included.
  std::vector<JointWrench> tree; // by System::tree_joints
  std::vector<JointWrench> cuts; // by System::cuts; zero for gears
  // On a bearing's second body, about its point as carried by that; by System::bearings.
  std::vector<JointWrench> bearings;
  // By the motor, positive along its coordinate, gears' loads included: N m or N, by System::drives; zero for
  // coordinates driven through gears.
  std::vector<double> drives;
  std::vector<GearForces> gears; // those that are cuts, then those between driven coordinates
};

// `kinematics` and `residual` must be at the same state.
TransmittedForces transmitted_forces(const System& system, const Parameters& parameters,
                                     const Eigen::VectorXd& lambda, const Kinematics<double>& kinematics,
                                     const Residual<double>& residual);

} // namespace flyball
