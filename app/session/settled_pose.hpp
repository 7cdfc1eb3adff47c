// Where a mechanism has settled, as a configuration that it can be drawn in.
#pragma once

#include "engine/mechanism/mechanism_pose.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

// Of a steady state of the mechanism, at the drawn phase of its drives.
MechanismPose settled_pose(const Mechanism& mechanism, const Solution& solution);

} // namespace flyball
