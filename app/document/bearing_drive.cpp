#include "app/document/bearing_drive.hpp"

#include "app/document/create.hpp"
#include "app/document/remove.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace flyball {
namespace {

struct Held {
  std::vector<std::size_t> bearings; // forces
  std::string in;                    // the body that they are in
  Vec3 axis = Vec3::UnitZ();         // unit vector
  Vec3 at = Vec3::Zero();            // m, on the axis, beside the body's mass centre
  bool along = false;                // they are stiff along the axis, too
  std::string why;                   // they allow no drive, a sentence
};

bool joins(const Joint& joint, const std::string& a, const std::string& b) {
  return joint.type != JointType::gear &&
         ((joint.bodies[0] == a && joint.bodies[1] == b) || (joint.bodies[0] == b && joint.bodies[1] == a));
}

Held held_by_bearings(const Mechanism& mechanism, const std::string& name) {
  Held held;
  const int b = body_index(mechanism, name);
  const auto refuse = [&](std::string why) {
    held.why = std::move(why);
    return held;
  };
  for (std::size_t f = 0; f < mechanism.forces.size(); ++f)
    if (mechanism.forces[f].type == ForceType::bearing && mechanism.forces[f].bodies[1] == name)
      held.bearings.push_back(f);
  if (b < 0 || held.bearings.empty()) return refuse("No bearing holds " + name + ".");
  const Body& body = mechanism.bodies[static_cast<std::size_t>(b)];
  const Force& first = mechanism.forces[held.bearings[0]];
  held.in = first.bodies[0];
  held.axis = first.axis.stableNormalized();
  const Vec3 at = first.at.value_or(body.position);
  for (const std::size_t f : held.bearings) {
    const Force& bearing = mechanism.forces[f];
    held.along = held.along || bearing_size(bearing) == 6;
    if (bearing.bodies[0] != held.in) return refuse("Its bearings are in several bodies.");
    const Vec3 there = bearing.at.value_or(body.position) - at;
    const double size = std::max(there.norm(), 1e-3);
    if (bearing.axis.stableNormalized().cross(held.axis).norm() > 1e-6 ||
        (there - held.axis * held.axis.dot(there)).norm() > 1e-6 * size)
      return refuse("Its bearings are not on one axis.");
  }
  held.at = at + held.axis * held.axis.dot(body.position - at);
  for (const Joint& joint : mechanism.joints)
    if (joint.type != JointType::free && joins(joint, name, held.in))
      return refuse(joint.name + " joins " + name + " and " + held.in + " already, beside the bearings.");
  return held;
}

} // namespace

std::string bearing_drive_refused(const Mechanism& mechanism, const std::string& body) {
  return held_by_bearings(mechanism, body).why;
}

std::string give_bearing_drive(Mechanism& mechanism, const std::string& body, double speed) {
  const Held held = held_by_bearings(mechanism, body);
  if (!held.why.empty()) throw SceneError("bodies." + body, held.why);
  Mechanism next = mechanism;
  Selection freely; // what it moved by
  for (const Joint& joint : next.joints)
    if (joint.type == JointType::free && joins(joint, body, held.in))
      freely.add({PartKind::joint, joint.name});
  remove_parts(next, freely);
  Vec3::Index least = 0;
  held.axis.cwiseAbs().minCoeff(&least);
  const Vec3 unit = Vec3::Unit(least);
  const Vec3 across = (unit - held.axis * held.axis.dot(unit)).normalized(),
             other = held.axis.cross(across).array() + 0.0;
  std::string last = held.in;
  const auto massless = [&](const char* stem) {
    Body made;
    made.name = unused_name(next, PartKind::body, stem);
    made.position = held.at;
    next.bodies.push_back(made);
    return made.name;
  };
  const auto join = [&](const char* stem, JointType type, const std::string& child, const Vec3& axis) {
    add_joint(next, type, {last, child}, held.at, axis, other);
    next.joints.back().name = unused_name(next, PartKind::joint, stem);
    last = child;
  };
  if (held.along) join("along", JointType::prismatic, massless("slide"), held.axis);
  join("up", JointType::prismatic, massless("slide"), across);
  join("across", JointType::prismatic, massless("yoke"), other);
  const std::string sleeve = massless("sleeve");
  join("tilt", JointType::universal, sleeve, across);
  join("spin", JointType::revolute, body, held.axis);
  Joint& spin = next.joints.back();
  spin.coordinates.resize(1);
  spin.coordinates[0].drive.emplace().speed = speed;
  for (Force& force : next.forces)
    if (force.type == ForceType::bearing && force.bodies[1] == body) force.bodies[1] = sleeve;
  const std::string driven = spin.name;
  mechanism = std::move(next);
  return driven;
}

} // namespace flyball
