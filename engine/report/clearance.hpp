// How far two bodies of spheres and capsules are apart.
#pragma once

#include "engine/system/point_motion.hpp"

#include <span>

namespace flyball {

// A sphere, or what is within a radius of a line.
struct Solid {
  TrackedPoint from, to;
  double radius = 0; // m
};

// m, below zero where they overlap; infinite where one has no solids. Between which points it is: on the
// centre lines.
struct Clearance {
  double gap = 0;
  TrackedPoint a, b;
};
Clearance find_clearance(const Kinematics<double>& kinematics, std::span<const Solid> one,
                         std::span<const Solid> other);

} // namespace flyball
