#include "app/session/pull.hpp"

namespace flyball {

std::shared_ptr<const Mechanism> pulled(const Mechanism& mechanism, const Pull& pull) {
  auto out = std::make_shared<Mechanism>(mechanism);
  Force spring;
  spring.name = "hand";
  while (force_index(mechanism, spring.name) >= 0)
    spring.name += "'";
  spring.type = ForceType::spring;
  spring.bodies = {pull.holder, pull.body};
  spring.points = {pull.hand, pull.at};
  spring.stiffness = pull.stiffness;
  spring.free_length = 0;
  out->forces.push_back(std::move(spring));
  return out;
}

Vec3 pulling_force(const Mechanism& mechanism, std::span<const Pose> poses, const Pull& pull) {
  const Vec3 hand = carried_point(mechanism, poses, body_index(mechanism, pull.holder), pull.hand);
  return pull.stiffness * (hand - carried_point(mechanism, poses, body_index(mechanism, pull.body), pull.at));
}

Vec3 drawn_point(const Mechanism& mechanism, std::span<const Pose> poses, int body, const Vec3& world) {
  if (body < 0) return world;
  const auto i = static_cast<std::size_t>(body);
  const Body& b = mechanism.bodies[i];
  return b.position + b.rotation.normalized() * (poses[i].rotation.conjugate() * (world - poses[i].position));
}

} // namespace flyball
