// Parts to build mechanisms from, and ways to read solutions, for the tests of solving.
#pragma once

#include "tests/catch.hpp"

#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace flyball::test {

// Failures are told with all digits: they are about the last ones.
inline const bool all_digits = [] {
  Catch::StringMaker<double>::precision = 17;
  return true;
}();

inline constexpr double standard_gravity = 9.80665; // m/s^2

inline Mechanism shipped(const std::string& name) {
  return load_scene(FLYBALL_ASSETS "/scenes/" + name + ".json");
}

// The shipped scene with some of its numbers changed.
inline Mechanism shipped(const std::string& name,
                         const std::vector<std::pair<std::string, double>>& changes) {
  Mechanism m = shipped(name);
  for (const auto& [address, value] : changes)
    set_parameter(m, address, value);
  return m;
}

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

inline Solution solve(const Mechanism& m, const SolveOptions& options = {}) {
  validate(m);
  return Analysis(m).solve(options);
}

inline SolveOptions nearest() {
  SolveOptions o;
  o.nearest = true;
  return o;
}

inline SolveOptions from(const std::string& joint, double value) {
  SolveOptions o;
  o.start = {{joint, value}};
  return o;
}

inline const CoordinateSolution& coordinate(const Solution& s, const std::string& joint, int index = 0) {
  const auto found = std::ranges::find_if(
      s.coordinates, [&](const CoordinateSolution& c) { return c.joint == joint && c.index == index; });
  INFO(s.message);
  REQUIRE(found != s.coordinates.end());
  return *found;
}

inline double value(const Solution& s, const std::string& joint, int index = 0) {
  return coordinate(s, joint, index).value;
}

// The root of an increasing or decreasing f between `a` and `b`, by bisection to the last digit.
template <class F>
long double root(F f, long double a, long double b) {
  const bool rising = f(b) > 0;
  REQUIRE((f(a) > 0) != rising);
  for (int i = 0; i < 200; ++i) {
    const long double middle = (a + b) / 2;
    ((f(middle) > 0) == rising ? b : a) = middle;
  }
  return (a + b) / 2;
}

// Within what the solution claims, and within `tolerance` of what is wanted.
inline void check_value(const Solution& s, const std::string& joint, long double wanted,
                        double tolerance = 1e-12, int index = 0) {
  const CoordinateSolution& c = coordinate(s, joint, index);
  const auto away = static_cast<double>(std::abs(c.value - wanted));
  const auto rounding = static_cast<double>(std::abs(wanted)) * 1e-16;
  CAPTURE(joint, index, c.value, static_cast<double>(wanted), c.error, s.message);
  CHECK(away <= tolerance);
  CHECK(away <= c.error + rounding);
}

inline bool stable(const Solution& s) {
  return s.stable == true;
}

} // namespace flyball::test
