// Springs from 1e-9 to 1e15: all of a shipped scene, and soft beside stiff in one mechanism.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

namespace flyball::stress {
namespace {

using namespace flyball::test;

// Rods hinged end to end, drawn level, each hinge with a spring of its own.
Mechanism sprung_chain(const std::vector<double>& stiffness, double speed) {
  Mechanism m = hanging_chain(static_cast<int>(stiffness.size()), speed);
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    m.joints[i + 1] = sprung(m.joints[i + 1], stiffness[i], 0.3);
  return m;
}

// Blocks that slide along gravity, one hung on the other by springs.
Mechanism hung_blocks(const std::vector<double>& stiffness) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  std::string above{ground_name};
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const std::string name = "block" + std::to_string(i + 1);
    const Vec3 at{0, -0.1 * static_cast<double>(i + 1), 0};
    m.bodies.push_back(body(name, 1, at));
    m.joints.push_back(
        sprung(prismatic("slide" + std::to_string(i + 1), above, name, at, {0, 1, 0}), stiffness[i], 0.02));
    above = name;
  }
  return m;
}

// A ball held by springs from four sides, one of them of another stiffness.
Mechanism held_ball(double three, double one) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("ball", 0.3, {0, 0, 0}, {1e-3, 1e-3, 1e-3})};
  m.joints = {joint(JointType::spherical, "turn", "carrier", "ball", {0, 0, 0})};
  m.bodies.push_back(body("carrier", 0, {0, 0, 0}));
  m.joints.push_back(joint(JointType::planar, "plane", "ground", "carrier", {0, 0, 0}));
  const Vec3 ends[]{{1, 0, 0}, {-1, 0.2, 0}, {0, 1, 0}, {0.3, -1, 0}};
  for (int i = 0; i < 4; ++i) {
    Force f;
    f.name = "spring" + std::to_string(i);
    f.bodies = {"ground", "ball"};
    f.points = {ends[i], Vec3(0.05 * ends[i])};
    f.stiffness = i == 3 ? one : three;
    f.free_length = 0.5;
    m.forces.push_back(f);
  }
  m.joints[0] = sprung(sprung(sprung(m.joints[0], three, 0.1, 0), three, -0.2, 1), one, 0.1, 2);
  m.joints[1] = sprung(m.joints[1], 1, 0, 2);
  return m;
}

} // namespace

void add_stiffness_cases(const CaseChoice& choice, Cases& cases) {
  for (const NamedScene& scene : shipped_scenes()) {
    if (!has_springs(scene.mechanism)) continue;
    for (const double k : decades(-9, 15, 2, choice.thinned)) {
      Mechanism m = scene.mechanism;
      each_stiffness(m, [&](double& x) { x = k; });
      cases.push_back(solve_case("stiffness", scene.name + " all " + digits(k), m, {.must = must_rest(m)}));
    }
  }
  const std::vector<double> few = decades(-9, 15, 4, choice.thinned);
  for (const double a : few)
    for (const double b : few) {
      const std::string name = digits(a) + " beside " + digits(b);
      cases.push_back(
          solve_case("stiffness", "chain " + name, sprung_chain({a, b, a, b, a}, 3), {.must = true}));
      cases.push_back(solve_case("stiffness", "blocks " + name, hung_blocks({a, b, a}), {.must = true}));
      cases.push_back(solve_case("stiffness", "ball " + name, held_ball(a, b)));
    }
}

} // namespace flyball::stress
