// Points of bodies, and how they move.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>

namespace flyball {

// A point fixed in a body, in world coordinates of the drawn pose (m) like all else in a scene; the mass
// centre where it is not given.
struct BodyPoint {
  std::string body;
  std::optional<Vec3> at{};
  bool operator==(const BodyPoint&) const = default;
};

// "rod", or "rod:0.1,0,-2" as the command line has it.
std::string point_label(const BodyPoint& point);

// World frame: m, m/s, m/s^2.
struct PointMotion {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), acceleration = Vec3::Zero();
};

} // namespace flyball
