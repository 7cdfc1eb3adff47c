#include "app/document/transform.hpp"

#include "app/document/coordinate_image.hpp"
#include "app/document/image.hpp"
#include "engine/mechanism/mass_properties.hpp"

#include <algorithm>
#include <unordered_set>

namespace flyball {
namespace {

class Transform {
 public:
  Transform(Mechanism& mechanism, const Selection& selection, const Isometry& isometry, OuterJoints joints)
      : mechanism_(mechanism), isometry_(isometry), outer_(joints == OuterJoints::follow) {
    for (const Part& part : selection.parts) {
      if (part.kind == PartKind::body) bodies_.insert(part.name);
      if (part.kind == PartKind::joint) joints_.insert(part.name);
      if (part.kind == PartKind::force) forces_.insert(part.name);
    }
  }

  void run() {
    for (Joint& joint : mechanism_.joints)
      if (transform(joint)) follow(joint);
    for (Force& force : mechanism_.forces)
      transform(force); // while the bodies are still where they were
    for (Body& body : mechanism_.bodies)
      if (moves(body.name)) body = image_of(body, isometry_);
  }

 private:
  bool moves(const std::string& body) const { return bodies_.contains(body); }

  // An end of a link or spring goes with its body.
  void transform_ends(const std::array<std::string, 2>& bodies, std::array<Vec3, 2>& points) const {
    for (std::size_t end = 0; end < 2; ++end)
      if (moves(bodies[end])) points[end] = isometry_.point(points[end]);
  }

  // Whether all of it moved.
  bool transform(Joint& joint) const {
    if (joint.type == JointType::gear) return false;
    const bool first = moves(joint.bodies[0]), second = moves(joint.bodies[1]);
    const bool taken_along = outer_ && joint.type != JointType::distance && (first || second);
    if (joints_.contains(joint.name) || (first && second) || taken_along) {
      joint = image_of(joint, isometry_);
      return true;
    }
    if (joint.type == JointType::distance) transform_ends(joint.bodies, joint.points);
    return false;
  }

  // Only where there are axes of the joint to trade: most joints have their own, which turn.
  void follow(const Joint& joint) const {
    if (joint.type == JointType::spherical || joint.type == JointType::free)
      follow_coordinates(mechanism_, joint, images_of_coordinates(joint.type, isometry_));
  }

  void transform(Force& force) const {
    const bool selected = forces_.contains(force.name);
    if (force.type == ForceType::spring) {
      if (selected)
        force = image_of(force, isometry_, Quat::Identity(), false);
      else
        transform_ends(force.bodies, force.points);
      return;
    }
    if (force.type == ForceType::bearing) {
      const bool first = moves(force.bodies[0]), second = moves(force.bodies[1]);
      if (selected || (first && second) || (outer_ && (first || second)))
        force = image_of(force, isometry_, Quat::Identity(), false);
      return;
    }
    const bool with_body = moves(force.body);
    if (selected) {
      const int b = body_index(mechanism_, force.body);
      const Body* body = b < 0 ? nullptr : &mechanism_.bodies[static_cast<std::size_t>(b)];
      if (!with_body && body && !force.at) force.at = body->position;
      force = image_of(force, isometry_, body ? body->rotation : Quat::Identity(), with_body);
    } else if (with_body) {
      if (force.at) force.at = isometry_.point(*force.at);
      if (force.type == ForceType::vane) turn_vane(force, isometry_);
    }
  }

  Mechanism& mechanism_;
  Isometry isometry_;
  bool outer_; // joints to what stays go along
  std::unordered_set<std::string> bodies_, joints_, forces_;
};

// A point's place in the mechanism, const or not; nothing for a point that only stands for the mass centre.
template <class AMechanism>
auto find_point(AMechanism& mechanism, const PointId& point) -> decltype(&mechanism.gravity) {
  const auto [kind, index] = find_part(mechanism, point.part);
  const auto i = static_cast<std::size_t>(index), end = static_cast<std::size_t>(point.end);
  switch (kind) {
  case PartKind::none: break;
  case PartKind::body: return end == 0 ? &mechanism.bodies[i].position : nullptr;
  case PartKind::joint: {
    auto& joint = mechanism.joints[i];
    if (joint.type == JointType::distance) return end < 2 ? &joint.points[end] : nullptr;
    return end == 0 && has_at(joint.type) ? &joint.at : nullptr;
  }
  case PartKind::force: {
    auto& force = mechanism.forces[i];
    if (force.type == ForceType::spring) return end < 2 ? &force.points[end] : nullptr;
    return end == 0 && force.at ? &*force.at : nullptr;
  }
  }
  return nullptr;
}

// The mass centre that a force without a point of its own acts on.
std::optional<Vec3> default_point(const Mechanism& mechanism, const PointId& point) {
  if (point.end != 0 || point.part.kind != PartKind::force) return {};
  const int force = force_index(mechanism, point.part.name);
  if (force < 0) return {};
  const int body = body_index(mechanism, mechanism.forces[static_cast<std::size_t>(force)].body);
  if (body < 0) return {};
  return mechanism.bodies[static_cast<std::size_t>(body)].position;
}

bool has_place(const Shape& shape) {
  return is_rod(shape.type) || shape.at;
}

// The vector that all of a body follows: its mass centre, unless shapes have places of their own; or that of
// its one shape, of which the mass centre follows.
std::string place_address(const Body& body) {
  const std::string path = "bodies." + body.name;
  if (body.density)
    return body.shapes.size() == 1 && !is_rod(body.shapes[0].type) ? path + ".shapes.0.at" : "";
  return std::ranges::none_of(body.shapes, has_place) ? path + ".position" : "";
}

} // namespace

void move_parts(Mechanism& mechanism, const Selection& selection, const Vec3& by, OuterJoints joints) {
  if (by.allFinite()) Transform(mechanism, selection, translation(by), joints).run();
}

void rotate_parts(Mechanism& mechanism, const Selection& selection, const Vec3& centre, const Quat& rotation,
                  OuterJoints joints) {
  if (const auto isometry = rotation_about(centre, rotation))
    Transform(mechanism, selection, *isometry, joints).run();
}

std::vector<std::string> outer_joints(const Mechanism& mechanism, const Selection& selection) {
  std::unordered_set<std::string> bodies, joints;
  for (const Part& part : selection.parts) {
    if (part.kind == PartKind::body) bodies.insert(part.name);
    if (part.kind == PartKind::joint) joints.insert(part.name);
  }
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints)
    if (joint.type != JointType::gear && joint.type != JointType::distance && !joints.contains(joint.name) &&
        bodies.contains(joint.bodies[0]) != bodies.contains(joint.bodies[1]))
      names.push_back(joint.name);
  return names;
}

std::optional<Vec3> point_position(const Mechanism& mechanism, const PointId& point) {
  if (const Vec3* found = find_point(mechanism, point)) return *found;
  return default_point(mechanism, point);
}

std::string point_address(const Mechanism& mechanism, const PointId& point) {
  const std::string ends = "points." + std::to_string(point.end);
  const PartId id = find_part(mechanism, point.part);
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::joint)
    return "joints." + point.part.name + "." +
           (mechanism.joints[i].type == JointType::distance ? ends : "at");
  if (id.kind == PartKind::force)
    return "forces." + point.part.name + "." + (mechanism.forces[i].type == ForceType::spring ? ends : "at");
  return id.kind == PartKind::body && point.end == 0 ? place_address(mechanism.bodies[i]) : "";
}

void set_point(Mechanism& mechanism, const PointId& point, const Vec3& position, OuterJoints joints) {
  const std::optional<Vec3> now = point_position(mechanism, point);
  if (!now || !position.allFinite() || position == *now) return;
  if (point.part.kind == PartKind::body) move_parts(mechanism, {{point.part}}, position - *now, joints);
  if (Vec3* found = find_point(mechanism, point))
    *found = position;
  else
    mechanism.forces[static_cast<std::size_t>(force_index(mechanism, point.part.name))].at = position;
}

std::optional<Vec3> centre_of(const Mechanism& mechanism, const Selection& selection) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const Part& part : selection.parts)
    for (const int end : {0, 1})
      if (const auto point = point_position(mechanism, {part, end})) {
        sum += *point;
        ++count;
      }
  if (count == 0) return {};
  return sum / count;
}

} // namespace flyball
