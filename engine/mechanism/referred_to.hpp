// The joint and the coordinate that a CoordinateReference tells.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

auto& joint_of(auto& mechanism, CoordinateReference at) {
  return mechanism.joints[static_cast<std::size_t>(at.joint)];
}

auto& coordinate_of(auto& mechanism, CoordinateReference at) {
  return joint_of(mechanism, at).coordinates[static_cast<std::size_t>(at.coordinate)];
}

} // namespace flyball
