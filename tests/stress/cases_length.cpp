// Lengths from a micrometre to a thousand kilometres: whole mechanisms, and parts side by side.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "engine/mechanism/drive_law.hpp"
#include "tests/support/mechanisms.hpp"

#include <algorithm>

namespace flyball::stress {
namespace {

using namespace flyball::test;

// Point masses on massless rods of these lengths by turns, hinged end to end and drawn askew.
Mechanism uneven_chain(double even, double odd, double speed) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(speed)};
  std::string above = "spindle";
  Vec3 at = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    const double length = i % 2 == 0 ? even : odd, tilt = 0.1 + 0.05 * i;
    const std::string name = "bob" + std::to_string(i + 1);
    const Vec3 end = at + length * Vec3(std::sin(tilt), -std::cos(tilt), 0);
    m.bodies.push_back(body(name, 1, end));
    m.joints.push_back(revolute("hinge" + std::to_string(i + 1), above, name, at, {0, 0, 1}));
    above = name;
    at = end;
  }
  return m;
}

bool has_drive_law(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints, [&](const Joint& joint) {
    return std::ranges::any_of(joint.formulas,
                               [&](const Formula& formula) { return is_drive_law(mechanism, formula); });
  });
}

} // namespace

void add_length_cases(const CaseChoice& choice, Cases& cases) {
  const std::vector<double> few = decades(-6, 6, 2, choice.thinned);
  for (const NamedScene& scene : shipped_scenes())
    for (const double size : few) {
      if (choice.thinned && size == 1) continue; // a case of the scenes
      cases.push_back(solve_case("length", scene.name + " " + digits(size) + " times",
                                 resized(scene.mechanism, size), {.must = must_rest(scene.mechanism)}));
      // Other units of length, mass and time: what settles must settle whatever they are. A drive's law keeps
      // its own.
      if (!has_drive_law(scene.mechanism))
        cases.push_back(solve_case("length", scene.name + " in units of " + digits(size),
                                   alike(scene.mechanism, size, 1 / (size * size), std::sqrt(size)),
                                   {.must = true}));
    }
  for (const double even : few)
    for (const double odd : few)
      for (const double speed : {0., 2.})
        cases.push_back(
            solve_case("length", "chain " + digits(even) + " beside " + digits(odd) + " at " + digits(speed),
                       uneven_chain(even, odd, speed), {.must = true}));
}

} // namespace flyball::stress
