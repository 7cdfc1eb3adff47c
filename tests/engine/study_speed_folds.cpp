// Branches along which a speed that is found grows far beyond where its search begins.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/study/fold_curve.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

TEST_CASE("a torque against a load that falls and rises with speed has two folds", "[torque]") {
  // T = 3 w e^-w + w / 10 from 0.03 rad/s, with a fold where 3 (1 - w) e^-w + 1 / 10 = 0, to 29.9 rad/s.
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
  Joint spin = revolute("spin", "ground", "rotor", {0, 0, 0}, {0, 0, 1});
  Drive& drive = spin.coordinates[0].drive.emplace();
  drive.speed = GENERATE(0.1, 10.);
  drive.torque = 0.2;
  drive.load = 0;
  spin.formulas.push_back({"drive.load", "1 N m * (3 * rate(spin) / (1 rad/s) * exp(-rate(spin) / (1 rad/s))"
                                         " + 0.1 * rate(spin) / (1 rad/s))"});
  m.joints = {spin};
  validate(m);
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.torque", 0.1, 3);
  std::vector<double> folds;
  for (const SpecialPoint& p : d.special)
    if (p.type == SpecialPointType::fold) folds.push_back(p.at.parameter);
  std::ranges::sort(folds);
  REQUIRE(folds.size() == 2);
  const auto torque = [](double w) { return 3 * w * std::exp(-w) + 0.1 * w; };
  const auto fold = [](double low, double high) { // of the slope's sign
    const auto slope = [](double w) { return 3 * (1 - w) * std::exp(-w) + 0.1; };
    for (int i = 0; i < 100; ++i)
      (slope((low + high) / 2) * slope(low) > 0 ? low : high) = (low + high) / 2;
    return low;
  };
  CHECK_THAT(folds[0], WithinRel(torque(fold(3, 8)), 1e-9));
  CHECK_THAT(folds[1], WithinRel(torque(fold(0.5, 2)), 1e-9));
  REQUIRE(d.branches.size() == 1);
  CHECK(d.branches[0].points.size() < 1000);
  CHECK(d.branches[0].points.front().parameter == 0.1);
  CHECK(d.branches[0].points.back().parameter == 3); // though a step is long there
}

// A carriage 0.04 m from a sprung lift: its found speed of 5 m/s is no place 125 reaches away.
TEST_CASE("a slide by a force does not end curves by its speed", "[plane]") {
  Mechanism m;
  m.gravity = {0, -10, 0};
  m.bodies = {body("carriage", 1, {0, 0, 0}), body("lift", 1, {0, 0.04, 0})};
  m.joints = {torque_driven(prismatic("stage", "ground", "carriage", {0, 0, 0}, {1, 0, 0}), 4,
                            "10 N - 2 N s/m*rate(stage)"),
              sprung(prismatic("lift", "ground", "lift", {0, 0.04, 0}, {0, 1, 0}), 1000)};
  const PlaneCurves plane =
      value_curves(m, {"gravity.1", -12, -8}, {"joints.lift.spring.stiffness", 500, 2000}, "lift", -0.01);
  INFO(plane.message);
  REQUIRE(plane.curves.size() == 1);
  const PlaneCurve& curve = plane.curves[0];
  CHECK(std::abs(curve.points.front().x - curve.points.back().x) == Approx(4));
  for (const PlanePoint& p : curve.points) {
    CHECK(p.y == Approx(-p.x / 0.01).epsilon(1e-11));
    CHECK(p.coordinates[0].speed.value() == Approx(5).epsilon(1e-11));
  }
}

TEST_CASE("a branch ends where the speed grows without end, and rounding makes no folds there", "[torque]") {
  // The load comes to the most that the motor gives, 5.147 N m, at no speed; a bob hangs from the shaft.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, {0, 0, 0}, {0.05, 0.4279, 0.05}),
              body("bob", 1.208, {0.1059, -0.4091, -0.09746}, {0.03743, 0.03315, 0.0346})};
  Joint hang = joint(JointType::universal, "hang", "hub", "bob", {0, 0, 0}, {1, 0, 0});
  hang.axis2 = Vec3::UnitZ();
  hang.coordinates[0].damping = 0.06;
  hang.coordinates[1].damping = 0.15;
  m.joints = {torque_driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}), 12,
                            "5.147 N m*tanh(1.029 - 0.3 s*rate(spin))", "1"),
              hang};
  validate(m);
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.load", 0, 9);
  CHECK(d.special.empty());
  REQUIRE(d.branches.size() == 1);
  CHECK(d.branches[0].end ==
        "a speed grows more than a thousandfold there, while the number stays where it is");
  CHECK(d.branches[0].points.size() < 700);
  for (const ResponsePoint& p : d.branches[0].points)
    CHECK(p.parameter < 5.147 + 1e-6);
}
