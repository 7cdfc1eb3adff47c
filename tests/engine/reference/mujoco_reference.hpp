// Inverse dynamics of open trees by MuJoCo, for tests that have it installed.
#pragma once

#include "engine/mechanism/pose.hpp"
#include "tests/engine/reference/tree.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flyball::reference {

// Whether this build has MuJoCo; without it the others throw.
bool mujoco_available();

// Whether MuJoCo can hold this mechanism: a tree, every body with mass and a definite inertia, no forces
// beside the joints, no stops, no springs or dampers on rotation vectors (its ball joint means something
// else).
bool mujoco_can_hold(const Mechanism& mechanism);

// The mechanism as an MJCF model whose body frames are aligned with the world in the drawn pose.
std::string to_mjcf(const Mechanism& mechanism);

// mj_inverse with the drives at their speeds, everything else at rest and no accelerations: by joint name
// what generalized_forces() gives. Throws std::invalid_argument where MuJoCo cannot hold the mechanism.
std::map<std::string, VectorR> mujoco_inverse(const Mechanism& mechanism, const ReferenceState& state);

// Where MuJoCo's Runge-Kutta method of order four takes an undriven mechanism from its drawn pose in this
// time (s) by steps of this size (s): bodies' mass centres (m) and rotations from the drawn pose, in the
// order of the bodies. `rates` are of coordinates at the start (rad/s, m/s) by "joint" or "joint.index"; none
// of rotation vectors. Throws std::invalid_argument where MuJoCo cannot hold the mechanism.
std::vector<Pose> mujoco_motion(const Mechanism& mechanism,
                                const std::vector<std::pair<std::string, double>>& rates, double duration,
                                double step);

} // namespace flyball::reference
