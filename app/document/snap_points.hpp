// Points of a mechanism that others are likely to be put on.
#pragma once

#include "app/document/part.hpp"

#include <string>
#include <vector>

namespace flyball {

struct SnapPoint {
  Vec3 point = Vec3::Zero(); // m, world, drawn pose
  Part part;                 // whose it is
  std::string what;          // "arm1", "centre of ball1", "end of rod1", "point A", "origin"
  std::string named{};       // the named point that is there
  bool face = false;         // of a disc, which gives way to the disc's centre
};

// Joints' points, mass centres, ends of springs and distance joints, ends of bodies' rods, named points, and
// the origin; points that coincide once, in that order of preference.
std::vector<SnapPoint> snap_points(const Mechanism& mechanism);

} // namespace flyball
