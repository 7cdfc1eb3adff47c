// The space something takes.
#pragma once

#include "engine/mechanism/pose.hpp"

namespace flyball {

// Axis-aligned box in world coordinates (m).
struct Bounds {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  bool empty = true;

  void add(const Vec3& point) {
    if (!point.allFinite()) return;
    lower = empty ? point : lower.cwiseMin(point);
    upper = empty ? point : upper.cwiseMax(point);
    empty = false;
  }
  void add(const Bounds& other) {
    if (other.empty) return;
    add(other.lower);
    add(other.upper);
  }
  Vec3 center() const { return 0.5 * lower + 0.5 * upper; }
  double radius() const { return (0.5 * upper - 0.5 * lower).norm(); } // m, of the ball around the box
};

} // namespace flyball
