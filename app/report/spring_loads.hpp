// What springs and stops bear in a steady state.
#pragma once

#include "engine/solve/solution.hpp"

#include <vector>

namespace flyball {

struct SpringLoad {
  std::string name;      // of the joint's coordinate, or of the force
  const char* kind = ""; // "spring on a joint"
  bool angle = false;    // rad and N m rather than m and N
  double at = 0;         // the coordinate's value, or the spring's length: rad or m
  double deflection = 0; // beyond where it is slack: rad or m
  double force = 0;      // elastic; along the coordinate, or of a spring between bodies its tension: N or N m
  double energy = 0;     // J
};

// Springs and stops of the joints' coordinates, where a stop is touched, then springs between bodies. Of a
// solution that has poses.
std::vector<SpringLoad> spring_loads(const Mechanism& mechanism, const Solution& solution);

} // namespace flyball
