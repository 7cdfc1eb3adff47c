// Poses at which a Jacobian loses rank: arms straight, a slider at no radius, dead centre, a flat linkage.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

#include <numbers>

namespace flyball::stress {
namespace {

using namespace flyball::test;

constexpr double pi = std::numbers::pi;

// A slider across the spindle, its mass centre `radius` from the axis.
Mechanism slider(double radius, double stiffness, double speed) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(), body("block", 1, {radius, 0.1, 0})};
  m.joints = {spin(speed),
              sprung(prismatic("slide", "spindle", "block", {radius, 0.1, 0}, {1, 0, 0}), stiffness)};
  return m;
}

// A slider-crank on a turntable that does not turn, crank up, rod down: at its dead centres the slider does
// not move with the crank. `spring` acts on the crank.
Mechanism dead_centre(double crank, double rod, double spring, double free) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("crank", 1, {0, crank / 2, 0}, {1e-3, 1e-3, 1e-3}),
              body("rod", 1, {0, crank - rod / 2, 0}, {1e-3, 1e-3, 1e-3}),
              body("block", 2, {0, crank - rod, 0})};
  m.joints = {revolute("crank", "ground", "crank", {0, 0, 0}, {0, 0, 1}),
              revolute("knee", "crank", "rod", {0, crank, 0}, {0, 0, 1}),
              revolute("foot", "rod", "block", {0, crank - rod, 0}, {0, 0, 1}),
              prismatic("slide", "ground", "block", {0, crank - rod, 0}, {0, 1, 0})};
  if (spring != 0) m.joints[0] = sprung(m.joints[0], spring, free);
  return m;
}

// Two rods whose far end is tied to a fixed point by a string: at a length of 2 only straight arms close it.
Mechanism stretched(double span) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("first", 1, {0.5, 0, 0}, {0.01, 0.01, 0.01}),
              body("second", 1, {1.5, 0, 0}, {0.01, 0.01, 0.01})};
  m.joints = {revolute("root", "ground", "first", {0, 0, 0}, {0, 0, 1}),
              revolute("elbow", "first", "second", {1, 0, 0}, {0, 0, 1}),
              distance("string", "ground", "second", {span + 0.5, 0, 0}, {2, 0, 0}, 0.5)};
  return m;
}

// A parallelogram linkage of unit bars drawn flat: at once a parallelogram and a kite.
Mechanism flat_parallelogram(double tilt) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  const Vec3 arm{std::sin(tilt), -std::cos(tilt), 0}, base{0, -1.5, 0};
  m.bodies = {body("left", 1, 0.5 * arm, {0.01, 0.01, 0.01}),
              body("coupler", 1, arm + 0.5 * base, {0.01, 0.01, 0.01}),
              body("right", 1, base + 0.5 * arm, {0.01, 0.01, 0.01})};
  m.joints = {revolute("left", "ground", "left", {0, 0, 0}, {0, 0, 1}),
              revolute("top", "left", "coupler", arm, {0, 0, 1}),
              revolute("right", "ground", "right", base, {0, 0, 1}),
              revolute("bottom", "coupler", "right", base + arm, {0, 0, 1})};
  return m;
}

} // namespace

void add_singular_cases(const CaseChoice& choice, Cases& cases) {
  const auto add = [&](const std::string& name, const Mechanism& m, const Expectation& e,
                       const SolveOptions& o = {}) {
    cases.push_back(solve_case("singular poses", name, m, e, o));
  };
  for (const int links : {1, 2, 5})
    for (const double speed : {0., 2., 20.}) {
      SolveOptions upright;
      upright.start = {{"hinge1", pi}};
      const std::string name = "chain of " + std::to_string(links) + " at " + digits(speed);
      add(name + " hanging", hanging_chain(links, speed), {.must = true});
      add(name + " upright", hanging_chain(links, speed), {.must = true}, upright);
      SolveOptions folded;
      folded.start = {{"hinge" + std::to_string(links), pi}};
      add(name + " folded", hanging_chain(links, speed), {.must = true}, folded);
    }
  for (const double stiffness : decades(-6, 12, 3, choice.thinned))
    for (const double share : {0., 0.5, 0.999999999, 2.}) // of m w^2 in k
      for (const double radius : {0., 1e-12, 0.1})
        add("slider " + digits(radius) + " k " + digits(stiffness) + " share " + digits(share),
            slider(radius, stiffness, std::sqrt(share * stiffness)),
            {.must = share < 0.9}); // near one the stiffness is a difference that cancels
  for (const double rod : {1.5, 3., 1.0000001}) {
    add("dead centre rod " + digits(rod), dead_centre(1, rod, 0, 0), {.must = true});
    for (const double spring : {1e-6, 1., 1e6})
      add("dead centre rod " + digits(rod) + " spring " + digits(spring), dead_centre(1, rod, spring, 0.5),
          {.must = true});
  }
  add("dead centre rod as long as crank", dead_centre(1, 1, 1, 0.5), {});
  for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 0., -1e-6})
    add("straight arms, slack " + digits(gap), stretched(2 - gap), {.must = gap > 1e-8});
  for (const double tilt : {0., 1e-9, 1e-5, 0.1})
    add("flat parallelogram, tilt " + digits(tilt), flat_parallelogram(tilt), {.must = tilt > 1e-3});
  for (const NamedScene& scene : shipped_scenes()) {
    if (scene.name != "governor" && scene.name != "governor_bearing" && scene.name != "watt_governor")
      continue;
    for (const double angle : {0., pi / 2, pi, 1e-9}) {
      SolveOptions straight;
      for (const Joint& j : scene.mechanism.joints)
        if (j.name == "arm1" || j.name == "arm2") straight.start.emplace_back(j.name, angle);
      add(scene.name + " arms at " + digits(angle), scene.mechanism, {}, straight);
    }
  }
}

} // namespace flyball::stress
