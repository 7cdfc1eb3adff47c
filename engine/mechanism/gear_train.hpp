// What gears, belts, racks and screws tie to a coordinate.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <vector>

namespace flyball {

struct GearedCoordinate {
  CoordinateReference at;
  double ratio = 1; // its rate over that of the coordinate that was asked for
};

// All coordinates that gears tie to one, each once, itself first; `without`: as if this gear were not there.
std::vector<GearedCoordinate> gear_train(const Mechanism& mechanism, CoordinateReference coordinate,
                                         const Joint* without = nullptr);

} // namespace flyball
