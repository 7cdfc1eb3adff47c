#include "app/document/snap_points.hpp"

#include <algorithm>

namespace flyball {
namespace {

class Collector {
 public:
  void add(const Vec3& point, Part part, std::string what) {
    const auto there = [&](const SnapPoint& other) {
      constexpr double same = 1e-9;
      return (other.point - point).norm() <= same * (1 + point.norm());
    };
    if (!point.allFinite() || std::ranges::any_of(all_, there)) return;
    all_.push_back({point, std::move(part), std::move(what)});
  }
  std::vector<SnapPoint> take() { return std::move(all_); }

 private:
  std::vector<SnapPoint> all_;
};

} // namespace

std::vector<SnapPoint> snap_points(const Mechanism& mechanism) {
  Collector all;
  for (const Joint& joint : mechanism.joints)
    if (has_at(joint.type)) all.add(joint.at, {PartKind::joint, joint.name}, joint.name);
  for (const Body& body : mechanism.bodies)
    all.add(body.position, {PartKind::body, body.name}, "centre of " + body.name);
  for (const Force& force : mechanism.forces)
    if (force.type == ForceType::spring)
      for (const Vec3& point : force.points)
        all.add(point, {PartKind::force, force.name}, "end of " + force.name);
  for (const Joint& joint : mechanism.joints)
    if (joint.type == JointType::distance)
      for (const Vec3& point : joint.points)
        all.add(point, {PartKind::joint, joint.name}, "end of " + joint.name);
  for (const Body& body : mechanism.bodies)
    for (const Shape& shape : body.shapes)
      if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule)
        for (const Vec3& point : {shape.from, shape.to})
          all.add(point, {PartKind::body, body.name}, "end of " + body.name);
  all.add(Vec3::Zero(), {}, "origin");
  return all.take();
}

} // namespace flyball
