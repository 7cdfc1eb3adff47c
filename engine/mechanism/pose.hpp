// Where bodies are.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <vector>

namespace flyball {

// Of one body: `position` is p_WB of the mass centre (m), `rotation` is R_WB, body axes to world axes.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
};

// The poses the mechanism is drawn in, in the order of its bodies.
inline std::vector<Pose> drawn_poses(const Mechanism& mechanism) {
  std::vector<Pose> poses;
  poses.reserve(mechanism.bodies.size());
  for (const Body& b : mechanism.bodies)
    poses.push_back({b.position, b.rotation.normalized()});
  return poses;
}

// Where a point fixed in `body` (-1: ground), given in world coordinates of the drawn pose, is when the
// bodies stand in `poses` (m, world).
inline Vec3 carried_point(const Mechanism& mechanism, std::span<const Pose> poses, int body,
                          const Vec3& drawn) {
  if (body < 0) return drawn;
  const auto i = static_cast<std::size_t>(body);
  const Body& b = mechanism.bodies[i];
  return poses[i].position + poses[i].rotation * (b.rotation.normalized().conjugate() * (drawn - b.position));
}

// The same for a direction.
inline Vec3 carried_vector(const Mechanism& mechanism, std::span<const Pose> poses, int body,
                           const Vec3& drawn) {
  if (body < 0) return drawn;
  const auto i = static_cast<std::size_t>(body);
  return poses[i].rotation * (mechanism.bodies[i].rotation.normalized().conjugate() * drawn);
}

} // namespace flyball
