#include "app/document/create.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/document/names.hpp"
#include "engine/mechanism/mass_properties.hpp"

#include <cmath>

namespace flyball {

std::string form_name(BodyForm form) {
  switch (form) {
  case BodyForm::ball: return "ball";
  case BodyForm::block: return "block";
  case BodyForm::rod: return "rod";
  case BodyForm::plate: return "plate";
  case BodyForm::disc: return "disc";
  }
  return "body";
}

namespace {

// The axes of a rod: the world's, but for the one nearest to the rod, which lies along it.
Quat axes_along(const Vec3& direction) {
  Vec3::Index nearest = 0;
  if (!(direction.cwiseAbs().maxCoeff(&nearest) > 0)) return Quat::Identity();
  const Vec3 axis = direction[nearest] < 0 ? Vec3(-Vec3::Unit(nearest)) : Vec3(Vec3::Unit(nearest));
  const Vec3 unit = direction.stableNormalized();
  return unit == axis ? Quat::Identity() : Quat::FromTwoVectors(axis, unit);
}

bool parallel(const Vec3& a, const Vec3& b) {
  constexpr double tolerance = 1e-6;
  return a.stableNormalized().cross(b.stableNormalized()).norm() <= tolerance;
}

Vec3 unit_most_across(const Vec3& direction) {
  Vec3::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  return Vec3::Unit(least);
}

std::string add(Mechanism& mechanism, Joint joint, std::string_view stem) {
  joint.name = unused_name(mechanism, PartKind::joint, stem);
  mechanism.joints.push_back(std::move(joint));
  return mechanism.joints.back().name;
}

std::string add(Mechanism& mechanism, Force force, std::string_view stem) {
  force.name = unused_name(mechanism, PartKind::force, stem);
  mechanism.forces.push_back(std::move(force));
  return mechanism.forces.back().name;
}

} // namespace

std::string add_body(Mechanism& mechanism, const NewBody& wanted) {
  Body body;
  body.name = unused_name(mechanism, PartKind::body, form_name(wanted.form));
  body.position = wanted.at;
  Shape shape;
  switch (wanted.form) {
  case BodyForm::ball:
    shape.type = ShapeType::sphere;
    shape.radius = wanted.radius;
    break;
  case BodyForm::block:
  case BodyForm::plate:
    shape.type = ShapeType::box;
    shape.size = wanted.size;
    break;
  case BodyForm::rod:
  case BodyForm::disc:
    shape.type = ShapeType::cylinder;
    shape.radius = wanted.radius;
    shape.from = wanted.from;
    shape.to = wanted.to;
    body.position = 0.5 * (wanted.from + wanted.to);
    body.rotation = axes_along(wanted.to - wanted.from);
    break;
  }
  body.shapes.push_back(shape);
  take_mass_properties(body, wanted.density);
  mechanism.bodies.push_back(std::move(body));
  return mechanism.bodies.back().name;
}

std::string add_joint(Mechanism& mechanism, JointType type, const std::array<std::string, 2>& bodies,
                      const Vec3& at, const Vec3& axis, const Vec3& axis2) {
  Joint joint;
  joint.type = type;
  joint.bodies = bodies;
  if (has_at(type)) joint.at = at;
  if (has_axis(type)) joint.axis = axis;
  if (has_axis2(type)) joint.axis2 = parallel(axis, axis2) ? unit_most_across(axis) : axis2;
  joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(type)));
  return add(mechanism, std::move(joint), type_name(type));
}

std::string add_distance(Mechanism& mechanism, const std::array<std::string, 2>& bodies,
                         const std::array<Vec3, 2>& points) {
  Joint joint;
  joint.type = JointType::distance;
  joint.bodies = bodies;
  joint.points = points;
  return add(mechanism, std::move(joint), "link");
}

std::string add_gear(Mechanism& mechanism, const std::array<std::string, 2>& coordinates, double ratio,
                     GearKind kind) {
  Joint joint;
  joint.type = JointType::gear;
  joint.joints = coordinates;
  joint.ratio = ratio;
  if (kind != GearKind::gear) change_gear_kind(mechanism, joint, kind);
  return add(mechanism, std::move(joint), type_name(kind));
}

std::string add_spring(Mechanism& mechanism, const std::array<std::string, 2>& bodies,
                       const std::array<Vec3, 2>& points, double stiffness, double damping) {
  Force force;
  force.type = ForceType::spring;
  force.bodies = bodies;
  force.points = points;
  force.stiffness = stiffness;
  force.damping = damping;
  // Between points that coincide only a spring of no length has a direction.
  if (points[0] == points[1]) force.free_length = 0;
  return add(mechanism, std::move(force), stiffness == 0 && damping != 0 ? "damper" : "spring");
}

std::string add_bearing(Mechanism& mechanism, const std::array<std::string, 2>& bodies, const Vec3& at,
                        const Vec3& axis) {
  Force force;
  force.type = ForceType::bearing;
  force.bodies = bodies;
  force.at = at;
  force.axis = axis;
  force.bearing_stiffness = {usual_bearing_stiffness, 0, 0, usual_bearing_stiffness};
  force.bearing_damping = {usual_bearing_damping, 0, 0, usual_bearing_damping};
  return add(mechanism, std::move(force), "bearing");
}

std::string add_force(Mechanism& mechanism, ForceType type, const std::string& body, const Vec3& at,
                      const Vec3& vector) {
  Force force;
  force.type = type;
  force.body = body;
  force.at = at;
  switch (type) {
  case ForceType::drag: force.linear = 1; break;
  case ForceType::vane:
    force.area = 0.01;
    force.normal = vector;
    break;
  default: force.vector = vector;
  }
  return add(mechanism, std::move(force), type_name(type));
}

} // namespace flyball
