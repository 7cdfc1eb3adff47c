// Parts to build mechanisms from.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <cmath>
#include <optional>
#include <string>

namespace flyball::test {

inline constexpr double standard_gravity = 9.80665; // m/s^2

inline Body body(const std::string& name, double mass, const Vec3& position,
                 const Vec3& inertia = Vec3::Zero()) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.position = position;
  b.inertia = {inertia.x(), inertia.y(), inertia.z(), 0, 0, 0};
  return b;
}

inline Joint joint(JointType type, const std::string& name, const std::string& parent,
                   const std::string& child, const Vec3& at, const Vec3& axis = Vec3::UnitZ()) {
  Joint j;
  j.name = name;
  j.type = type;
  j.bodies = {parent, child};
  j.at = at;
  j.axis = axis;
  j.coordinates.resize(static_cast<std::size_t>(coordinate_count(type)));
  return j;
}

inline Joint revolute(const std::string& name, const std::string& parent, const std::string& child,
                      const Vec3& at, const Vec3& axis) {
  return joint(JointType::revolute, name, parent, child, at, axis);
}

inline Joint prismatic(const std::string& name, const std::string& parent, const std::string& child,
                       const Vec3& at, const Vec3& axis) {
  return joint(JointType::prismatic, name, parent, child, at, axis);
}

inline Joint distance(const std::string& name, const std::string& a, const std::string& b, const Vec3& on_a,
                      const Vec3& on_b, std::optional<double> length = {}) {
  Joint j;
  j.name = name;
  j.type = JointType::distance;
  j.bodies = {a, b};
  j.points = {on_a, on_b};
  j.length = length;
  return j;
}

inline Joint gear(const std::string& name, const std::string& a, const std::string& b, double ratio) {
  Joint j;
  j.name = name;
  j.type = JointType::gear;
  j.joints = {a, b};
  j.ratio = ratio;
  return j;
}

inline Joint driven(Joint j, double speed) {
  j.coordinates[0].drive = Drive{speed};
  return j;
}

inline Joint sprung(Joint j, double stiffness, double free = 0, std::size_t i = 0) {
  j.coordinates[i].spring = CoordinateSpring{stiffness, free};
  return j;
}

inline Joint dampened(Joint j, double damping, std::size_t i = 0) {
  j.coordinates[i].damping = damping;
  return j;
}

// A spindle on a vertical (y) axis through the origin.
inline Body spindle() {
  return body("spindle", 1, {0, 0, 0}, {0.1, 0.1, 0.1});
}
inline Joint spin(double speed, const Vec3& axis = Vec3::UnitY()) {
  return driven(revolute("spin", "ground", "spindle", {0, 0, 0}, axis), speed);
}

// A point mass on a massless rod, hinged about z at (offset, 0, 0) on the spindle; drawn at `angle` from
// hanging, outwards.
inline Mechanism conical(double length, double offset, double speed, double angle = 0, double mass = 1) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(),
              body("bob", mass, {offset + length * std::sin(angle), -length * std::cos(angle), 0})};
  m.joints = {spin(speed), revolute("swing", "spindle", "bob", {offset, 0, 0}, {0, 0, 1})};
  m.joints[1].coordinates[0].drawn = angle;
  return m;
}

// Thin rods hinged end to end about z, 1 m and 1 kg in all, hanging from the spindle's axis.
inline Mechanism hanging_chain(int count, double speed) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(speed)};
  const double length = 1. / count, mass = 1. / count, inertia = mass * length * length / 12;
  std::string above = "spindle";
  for (int i = 0; i < count; ++i) {
    const std::string number = std::to_string(i + 1), name = "link" + number;
    m.bodies.push_back(body(name, mass, {0, -(i + 0.5) * length, 0}, {inertia, 0, inertia}));
    m.joints.push_back(revolute("hinge" + number, above, name, {0, -i * length, 0}, {0, 0, 1}));
    above = name;
  }
  return m;
}

// The mechanism in another size: lengths times `factor`, inertias with their square.
inline Mechanism resized(Mechanism m, double factor) {
  for (Body& b : m.bodies) {
    b.position *= factor;
    for (double& i : b.inertia)
      i *= factor * factor;
  }
  for (Joint& j : m.joints) {
    j.at *= factor;
    for (Vec3& p : j.points)
      p *= factor;
    if (j.length) *j.length *= factor;
    for (std::size_t i = 0; i < j.coordinates.size(); ++i) {
      if (is_angle(j.type, static_cast<int>(i))) continue;
      Coordinate& c = j.coordinates[i];
      c.drawn *= factor;
      if (c.spring) c.spring->free *= factor;
    }
  }
  for (Force& f : m.forces) {
    for (Vec3& p : f.points)
      p *= factor;
    if (f.at) *f.at *= factor;
    if (f.free_length) *f.free_length *= factor;
  }
  return m;
}

inline Mechanism heavier(Mechanism m, double factor) {
  for (Body& b : m.bodies) {
    b.mass *= factor;
    for (double& i : b.inertia)
      i *= factor;
  }
  return m;
}

} // namespace flyball::test
