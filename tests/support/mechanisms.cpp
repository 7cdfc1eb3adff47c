#include "tests/support/mechanisms.hpp"

#include <cmath>

namespace flyball::test {

Body spindle() {
  return body("spindle", 1, {0, 0, 0}, {0.1, 0.1, 0.1});
}

Joint spin(double speed, const Vec3& axis) {
  return driven(revolute("spin", "ground", "spindle", {0, 0, 0}, axis), speed);
}

Mechanism conical(double length, double offset, double speed, double angle, double mass) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(),
              body("bob", mass, {offset + length * std::sin(angle), -length * std::cos(angle), 0})};
  m.joints = {spin(speed), revolute("swing", "spindle", "bob", {offset, 0, 0}, {0, 0, 1})};
  m.joints[1].coordinates[0].drawn = angle;
  return m;
}

Mechanism hanging_chain(int count, double speed) {
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

Mechanism resized(Mechanism m, double factor) {
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
    for (double& radius : j.radii)
      radius *= factor;
    j.lead *= factor;
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
    f.area *= factor * factor;
  }
  return m;
}

Mechanism heavier(Mechanism m, double factor) {
  for (Body& b : m.bodies) {
    b.mass *= factor;
    for (double& i : b.inertia)
      i *= factor;
  }
  return m;
}

} // namespace flyball::test
