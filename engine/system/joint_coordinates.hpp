// The coordinates of a joint from where its two bodies are, whichever joints make up the tree: how far the
// child has come from the drawn pose relative to the parent, labelled as in the scene file. For joints that
// close a loop, whose coordinates are no unknowns.
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

// What a joint's coordinates are measured along and about, in world axes of the drawn pose.
template <class N>
struct BasicJointFrame {
  // x, y, z (the joint's axis; of planar joints x is the in-plane axis), a universal joint's second axis.
  std::array<Vec3T<N>, 4> axes;
  std::array<N, 6> drawn{}; // rad or m, the labels of the drawn pose
};
// Instantiated for double and Dual.
template <class N>
BasicJointFrame<N> joint_frame(const Joint& joint, const NumberReader<N>& read);

using JointFrame = BasicJointFrame<double>;
inline JointFrame joint_frame(const Joint& joint) {
  return joint_frame<double>(joint, {});
}

struct JointCoordinates {
  // rad or m, coordinate_count(type) of them. Angles in (-pi, pi] from the label of the drawn pose, rotation
  // vectors of length at most pi.
  std::array<double, 6> value{};
  // (6, 6): rates of the coordinates by the child's velocity relative to the parent, see relative_velocity().
  Eigen::Matrix<double, 6, 6> rate = Eigen::Matrix<double, 6, 6>::Zero();
};

// `turn` R_PC and `shift` (m): the child's displacement from the drawn pose in the parent's axes, the latter
// of the joint's point as carried by the child from the same as carried by the parent.
JointCoordinates joint_coordinates(JointType type, const JointFrame& frame, const Mat3& turn,
                                   const Vec3& shift);

// Of the joint that a cut stands for, at evaluated kinematics.
JointCoordinates joint_coordinates(const CutJoint& cut, const CutParameters& parameters,
                                   const Kinematics<double>& kinematics);

// (w, v) of the child relative to the parent, in the parent's axes (rad/s, m/s): v of the child's point as
// seen from the parent.
using RelativeVelocity = Eigen::Matrix<double, 6, 1>;
RelativeVelocity relative_velocity(const CutJoint& cut, const CutParameters& parameters,
                                   const Kinematics<double>& kinematics);
// The same where one coordinate of q_R moves at unit speed and all others stand.
RelativeVelocity relative_velocity(const CutJoint& cut, const CutParameters& parameters,
                                   const Kinematics<double>& kinematics, const SupportColumn& column);

// An angle less whole turns: in (-pi, pi].
double wrapped_angle(double angle);

} // namespace flyball
