// Two coaxial shafts by torque, tied by a spring between points of each.
#pragma once

#include "engine/mechanism/validate.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"

#include <string>

namespace flyball::test {

// About z, through the origin.
inline Joint hinge(const std::string& name, const std::string& a, const std::string& b) {
  return revolute(name, a, b, {0, 0, 0}, {0, 0, 1});
}

// Two coaxial shafts, each with 2 N m - 0.2 N m s w, and a spring between points at 0.3 m of each.
// Their moments of inertia are 0.1 and 0.2 kg m^2.
inline Mechanism shafts(bool opposite) {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {0, 0, 0.5}, {0.2, 0.2, 0.2})};
  m.joints = {
      torque_driven(hinge("p", "ground", "a"), 5, "2 N m - 0.2 N m s * rate(p)"),
      torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 5, "2 N m - 0.2 N m s * rate(q)")};
  Force spring;
  spring.type = ForceType::spring;
  spring.name = "k";
  spring.bodies = {"a", "b"};
  spring.points = {Vec3(0.3, 0, 0), Vec3(opposite ? -0.3 : 0.3, 0, 0.5)};
  spring.stiffness = 50;
  spring.free_length = opposite ? 0.1 : 0.2;
  m.forces = {spring};
  validate(m);
  return m;
}

} // namespace flyball::test
