#include "app/viewport/bodies_near.hpp"

#include "app/viewport/assembly.hpp"
#include "app/viewport/picking.hpp"

#include <algorithm>
#include <limits>

namespace flyball {

std::vector<NearBody> bodies_near(const Mechanism& mechanism, std::span<const Instance> instances,
                                  const Vec3& point) {
  std::vector<NearBody> bodies(mechanism.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    bodies[i] = {static_cast<int>(i), std::numeric_limits<double>::infinity()};
  const auto include = [&](std::size_t body, double distance) {
    if (body < bodies.size()) bodies[body].distance = std::min(bodies[body].distance, distance);
  };
  for (const Instance& instance : instances)
    if (instance.part.kind == PartKind::body)
      include(static_cast<std::size_t>(instance.part.index), surface_distance(instance, point));
  const std::vector<Pose> drawn = drawn_poses(mechanism);
  const Assembly assembly(mechanism, drawn);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const Attachment& attachment : assembly.attachments[i])
      include(i, (attachment.at - point).norm());
  std::ranges::stable_sort(bodies, {}, &NearBody::distance);
  return bodies;
}

} // namespace flyball
