#include "app/viewport/box_select.hpp"

#include "app/viewport/assembly.hpp"

namespace flyball {

std::vector<PartAnchor> part_anchors(const Mechanism& mechanism, std::span<const Pose> poses) {
  std::vector<Pose> drawn;
  if (poses.size() != mechanism.bodies.size()) poses = drawn = drawn_poses(mechanism);
  const Assembly assembly(mechanism, poses);
  std::vector<PartAnchor> anchors;
  const auto add = [&](PartKind kind, std::size_t index, const Vec3& at) {
    if (at.allFinite()) anchors.push_back({{kind, static_cast<int>(index)}, at});
  };
  const auto middle = [&](const std::array<int, 2>& bodies, const std::array<Vec3, 2>& points) {
    return Vec3(0.5 * assembly.point(bodies[0], points[0]) + 0.5 * assembly.point(bodies[1], points[1]));
  };
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
    add(PartKind::body, i, poses[i].position);
  for (std::size_t i = 0; i < mechanism.joints.size(); ++i) {
    const Joint& joint = mechanism.joints[i];
    if (joint.type == JointType::distance)
      add(PartKind::joint, i, middle(assembly.joint_bodies[i], joint.points));
    else if (has_at(joint.type))
      add(PartKind::joint, i, assembly.point(assembly.joint_bodies[i][0], joint.at));
  }
  for (std::size_t i = 0; i < mechanism.forces.size(); ++i) {
    const Force& force = mechanism.forces[i];
    const int body = assembly.force_bodies[i][0];
    if (force.type == ForceType::spring)
      add(PartKind::force, i, middle(assembly.force_bodies[i], force.points));
    else if (force.type == ForceType::bearing)
      add(PartKind::force, i, assembly.point(assembly.force_bodies[i][1], force.at.value_or(Vec3::Zero())));
    else if (body >= 0)
      add(PartKind::force, i,
          assembly.point(body, force.at.value_or(mechanism.bodies[static_cast<std::size_t>(body)].position)));
  }
  return anchors;
}

std::vector<PartId> parts_in_frame(std::span<const PartAnchor> anchors, const ViewCamera& camera,
                                   ViewSize view, const std::array<Vec2, 2>& corners) {
  const Vec2 low = corners[0].cwiseMin(corners[1]), high = corners[0].cwiseMax(corners[1]);
  std::vector<PartId> found;
  for (const PartAnchor& anchor : anchors) {
    const auto pixel = camera.project(anchor.at, view);
    if (pixel && (pixel->array() >= low.array()).all() && (pixel->array() <= high.array()).all())
      found.push_back(anchor.part);
  }
  return found;
}

} // namespace flyball
