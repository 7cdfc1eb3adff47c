// Small mechanisms for the tests of the viewport, without shapes.
#pragma once

#include "engine/mechanism/pose.hpp"

#include <cmath>

namespace flyball::test {

inline Body make_body(const std::string& name, double mass, const Vec3& position) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.position = position;
  return body;
}

inline Joint make_joint(const std::string& name, JointType type, const std::string& parent,
                        const std::string& child, const Vec3& at, const Vec3& axis) {
  Joint joint;
  joint.name = name;
  joint.type = type;
  joint.bodies = {parent, child};
  joint.at = at;
  joint.axis = axis;
  joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(type)));
  return joint;
}

inline Joint make_link(const std::string& name, const std::string& first, const std::string& second,
                       const Vec3& a, const Vec3& b) {
  Joint joint;
  joint.name = name;
  joint.type = JointType::distance;
  joint.bodies = {first, second};
  joint.points = {a, b};
  return joint;
}

inline Mechanism governor() {
  Mechanism m;
  m.name = "Governor";
  m.gravity = {0, -9.80665, 0};
  m.bodies = {make_body("spindle", 200, {0, 0.2, 0}), make_body("ball1", 1, {-0.16, 0.2, 0}),
              make_body("ball2", 1, {0.16, 0.2, 0}), make_body("collar", 1, {0, 0.1256, 0})};
  Joint spin = make_joint("spin", JointType::revolute, "ground", "spindle", {0, 0.2, 0}, {0, 1, 0});
  spin.coordinates[0].drive = Drive{11.0174};
  Joint slide = make_joint("slide", JointType::prismatic, "spindle", "collar", {0, 0.1256, 0}, {0, -1, 0});
  slide.coordinates[0].drawn = 0.0744;
  slide.coordinates[0].spring = CoordinateSpring{1000, 0.15};
  slide.coordinates[0].damping = 30;
  m.joints = {spin,
              make_joint("arm1", JointType::revolute, "spindle", "ball1", {0, 0.2, 0}, {0, 0, 1}),
              make_joint("arm2", JointType::revolute, "spindle", "ball2", {0, 0.2, 0}, {0, 0, 1}),
              slide,
              make_link("link1", "ball1", "collar", {-0.08, 0.2, 0}, {0, 0.1256, 0}),
              make_link("link2", "ball2", "collar", {0.08, 0.2, 0}, {0, 0.1256, 0})};
  return m;
}

} // namespace flyball::test
