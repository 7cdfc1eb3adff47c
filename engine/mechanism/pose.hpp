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
std::vector<Pose> drawn_poses(const Mechanism& mechanism);

// Where a point fixed in `body` (-1: ground), given in world coordinates of the drawn pose, is when the
// bodies stand in `poses` (m, world).
Vec3 carried_point(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& drawn);

// The same for a direction.
Vec3 carried_vector(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& drawn);

} // namespace flyball
