#include "app/document/snap_points.hpp"

#include <map>

namespace flyball {
namespace {

class Collector {
 public:
  void add(const Vec3& point, Part part, std::string what, const std::string& named = {}, bool face = false) {
    if (!point.allFinite()) return;
    if (SnapPoint* other = there(point)) {
      if (other->named.empty()) other->named = named;
      return;
    }
    along_.emplace(direction().dot(point), all_.size());
    all_.push_back({point, std::move(part), std::move(what), named, face});
  }
  std::vector<SnapPoint> take() { return std::move(all_); }

 private:
  // Points are sorted along a direction that no mechanism lies across: what is near a point is near it there.
  static Vec3 direction() { return {0.5671, 0.3907, 0.7250}; }
  SnapPoint* there(const Vec3& point) {
    const double near = 1e-9 * (1 + point.norm()), at = direction().dot(point);
    for (auto other = along_.lower_bound(at - near); other != along_.end() && other->first <= at + near;
         ++other)
      if ((all_[other->second].point - point).norm() <= near) return &all_[other->second];
    return nullptr;
  }

  std::vector<SnapPoint> all_;
  std::multimap<double, std::size_t> along_; // by place along direction()
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
    else if (force.type == ForceType::bearing && force.at)
      all.add(*force.at, {PartKind::force, force.name}, force.name);
  for (const Joint& joint : mechanism.joints)
    if (joint.type == JointType::distance)
      for (const Vec3& point : joint.points)
        all.add(point, {PartKind::joint, joint.name}, "end of " + joint.name);
  for (const Body& body : mechanism.bodies)
    for (const Shape& shape : body.shapes)
      if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule)
        for (const Vec3& point : {shape.from, shape.to})
          all.add(point, {PartKind::body, body.name}, "end of " + body.name, {},
                  (shape.to - shape.from).norm() < 2 * shape.radius);
  for (const NamedPoint& point : mechanism.points)
    all.add(point.at, {}, "point " + point.name, point.name);
  all.add(Vec3::Zero(), {}, "origin");
  return all.take();
}

} // namespace flyball
