// A configuration of a mechanism as a person reads it.
#pragma once

#include "engine/mechanism/pose.hpp"

#include <array>
#include <vector>

namespace flyball {

struct MechanismPose {
  std::vector<Pose> bodies; // in the order of the mechanism's
  // By joint of the mechanism: rad or m, as its coordinates are labelled in the drawn pose; the first
  // coordinate_count() of each.
  std::vector<std::array<double, 6>> coordinates;
};

} // namespace flyball
