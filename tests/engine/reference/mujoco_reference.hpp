// Inverse dynamics of open trees by MuJoCo, for tests that have it installed.
#pragma once

#include "tests/engine/reference/tree.hpp"

#include <map>
#include <string>

namespace flyball::reference {

// Whether this build has MuJoCo; without it mujoco_inverse throws.
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

} // namespace flyball::reference
