// A spring between a hand and a point of a body, at which a mechanism is pulled while it is explored: no part
// of the document, and gone with the hand.
//
// With drives that turn, a hand that stood still in the world would make the balance turn with them, and
// nothing would settle. So the hand turns along: its end of the spring is fixed in the body that carries the
// drive, or in the ground where nothing turns (see Grip).
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/mechanism/pose.hpp"

#include <memory>
#include <span>
#include <string>

namespace flyball {

struct Pull {
  std::string body;         // that is pulled
  Vec3 at = Vec3::Zero();   // m, of it, in the drawn pose
  std::string holder;       // that the hand's end is fixed in
  Vec3 hand = Vec3::Zero(); // m, of the holder, in the drawn pose
  double stiffness = 0;     // N/m; it is slack at no length
  bool operator==(const Pull&) const = default;
};

// The mechanism with that spring as its last force.
std::shared_ptr<const Mechanism> pulled(const Mechanism& mechanism, const Pull& pull);
// N, on the body: where it stands in these poses, of one phase.
Vec3 pulling_force(const Mechanism& mechanism, std::span<const Pose> poses, const Pull& pull);

// The inverse of carried_point(): which point of the body, in world coordinates of the drawn pose, is at
// `world` (m) when the bodies stand in `poses`. -1 is the ground.
Vec3 drawn_point(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& world);

} // namespace flyball
