#include "engine/mechanism/pose.hpp"

namespace flyball {

std::vector<Pose> drawn_poses(const Mechanism& mechanism) {
  std::vector<Pose> poses;
  poses.reserve(mechanism.bodies.size());
  for (const Body& b : mechanism.bodies)
    poses.push_back({b.position, b.rotation.normalized()});
  return poses;
}

Vec3 carried_point(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& drawn) {
  if (body < 0) return drawn;
  const auto i = static_cast<std::size_t>(body);
  const Body& b = mechanism.bodies[i];
  return poses[i].position + poses[i].rotation * (b.rotation.normalized().conjugate() * (drawn - b.position));
}

Vec3 carried_vector(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& drawn) {
  if (body < 0) return drawn;
  const auto i = static_cast<std::size_t>(body);
  return poses[i].rotation * (mechanism.bodies[i].rotation.normalized().conjugate() * drawn);
}

} // namespace flyball
