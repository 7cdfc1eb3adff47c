// The pitch circles of gears, with teeth that mesh.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <array>
#include <vector>

namespace flyball {

struct Assembly;

// One wheel of a gear about parallel axes, in the drawn pose and carried by its body.
struct ToothedWheel {
  int body = -1;                 // that turns with it; -1 for none
  Vec3 center = Vec3::Zero();    // m
  Vec3 axis = Vec3::UnitZ();     // unit length
  Vec3 to_tooth = Vec3::UnitX(); // unit length, to the middle of a tooth
  double radius = 0;             // m, of the pitch circle; 0: no such wheel
  int teeth = 0;
  bool inside = false;  // a ring whose teeth point inwards
  bool is_first = true; // of the gears that share it; the others need not draw it again
};

// By joint, the wheels of a gear's coordinates a and b; their radius is 0 for other joints and where the axes
// are not parallel, lie on each other, or turn alike. Along their common axis the wheels lie before the
// shapes of what they turn with.
std::vector<std::array<ToothedWheel, 2>> toothed_wheels(const Assembly& assembly);

} // namespace flyball
