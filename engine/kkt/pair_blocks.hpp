// What acts between two bodies, as the bodies feel it: wrenches on both, and how they change with the motions
// of both beyond turning along with them (tree_kkt.hpp); and the rows of a cut joint.
//
// Wrenches and motions are about the links' origins; a is the first end, b the second.
#pragma once

#include "engine/kkt/body_stiffness.hpp"

namespace flyball {

struct PairBlocks {
  Mat6 aa, ab, ba, bb;     // of the balance on one body by the motion of another
  Vec6 on_a, on_b;         // what the balance asks for: dV by a unit of motion
  bool compressed = false; // a line under compression
  void set_zero();
  PairBlocks& operator+=(const PairBlocks& other);
};

// What springs and loops of a given length do across their line: compression takes off stiffness there, which
// a convex model leaves out.
enum class Lines { exact, convex };

// At velocities where `moving`: dampers between parts that turn against each other.
PairBlocks spring_blocks(const PointSpringElement& element, const PointSpringParameters& spring,
                         const Kinematics<double>& kinematics, bool moving, Lines lines);
PairBlocks damper_blocks(const CutDamperElement& element, const CutDamperParameters& damper,
                         const Kinematics<double>& kinematics);

// Of a constraint row that is no gear, with its multiplier.
PairBlocks row_blocks(const CutJoint& cut, const CutParameters& joint, const ConstraintRow& row,
                      double multiplier, const Kinematics<double>& kinematics, Lines lines);

// The row's change by a unit of motion of either body.
struct RowGradient {
  Vec6 a, b;
};
RowGradient body_row_gradient(const CutJoint& cut, const CutParameters& joint, const ConstraintRow& row,
                              const Kinematics<double>& kinematics);

// Of a damper between two bodies: how fast it is drawn or turned by a unit of either's velocity, and its
// constant (N s/m, N m s), so that the wrenches are -damping rate rate^T velocity.
struct PairDamping {
  RowGradient rate;
  double damping = 0;
};
PairDamping spring_damping(const PointSpringElement& element, const PointSpringParameters& spring,
                           const Kinematics<double>& kinematics);
PairDamping damper_damping(const CutDamperElement& element, const CutDamperParameters& damper,
                           const Kinematics<double>& kinematics);

} // namespace flyball
