// Backlash of gears as a stop: a wheel in a rim that turns by the gear without play, on which flank it lies
// and how far the teeth give way, by closed forms.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

constexpr double play = 0.02, mesh = 5000, ratio = -0.5, inertia = 0.1; // rad, N m/rad, kg m^2

Joint toothed(const std::string& name, const std::string& rim, const std::string& wheel, const Vec3& at,
              double width, double stiffness) {
  Joint j = dampened(revolute(name, rim, wheel, at), 0.5);
  j.coordinates[0].stop = Stop{-width / 2, width / 2, stiffness, ""};
  return j;
}

Force load_on(const std::string& wheel) {
  Force f;
  f.name = "load on " + wheel;
  f.type = ForceType::torque;
  f.body = wheel;
  f.vector = Vec3::UnitZ();
  return f;
}

// A pinion, and a wheel that its load presses against a flank.
Mechanism pair(double torque) {
  const Vec3 at(0.3, 0, 0);
  Mechanism m;
  m.parameters = {{"T", "", torque, "N m", {}}};
  m.bodies = {body("pinion", 1, {0, 0, 0}, {0.01, 0.01, 0.02}), body("rim", 0, at),
              body("wheel", 4, at, {inertia / 2, inertia / 2, inertia})};
  m.joints = {driven(revolute("in", "ground", "pinion", {0, 0, 0}), 10), revolute("out", "ground", "rim", at),
              gear("teeth", "in", "out", ratio), toothed("play", "rim", "wheel", at, play, mesh)};
  m.forces = {load_on("wheel")};
  m.forces[0].formulas = {{"vector.2", "T"}};
  set_parameter(m, "parameters.T", torque);
  return m;
}

Solution settled(const Mechanism& m) {
  validate(m);
  Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return s;
}

double on_flank(double torque, double width = play, double stiffness = mesh) {
  return std::copysign(width / 2, torque) + torque / stiffness;
}

} // namespace

TEST_CASE("a load presses a wheel with backlash against a flank", "[backlash]") {
  for (const double torque : {3., -3., 1e-4, -200., 40.}) {
    CAPTURE(torque);
    const Solution s = settled(pair(torque));
    CHECK_THAT(value(s, "play"), WithinRel(on_flank(torque), 1e-13));
    CHECK(s.stable == true);
    CHECK(s.iterations < 10);
    CHECK(s.fallback == Fallback::stops);
    REQUIRE(s.drive_torques.size() == 1);
    CHECK_THAT(s.drive_torques[0].value, WithinRel(-ratio * torque, 1e-12));
    // At constant speed: J q'' + c q' + k q = 0.
    REQUIRE(s.eigenvalues);
    REQUIRE(s.eigenvalues->size() == 2);
    CHECK_THAT(std::norm(s.eigenvalues->front()), WithinRel(mesh / inertia, 1e-10));
  }
}

TEST_CASE("without a load a wheel stands anywhere in its play, which is said", "[backlash]") {
  for (const double damping : {0., 0.5}) {
    Mechanism m = pair(0);
    m.joints[3].coordinates[0].damping = damping;
    const Solution s = settled(m);
    CAPTURE(s.message);
    CHECK(std::abs(value(s, "play")) <= play / 2);
    CHECK(s.stability_reason == StabilityReason::neutral);
    CHECK(s.neutral == std::vector<std::string>{"play"});
    CHECK_FALSE(s.stable);
    CHECK_THAT(s.message, ContainsSubstring("arbitrary between stops"));
  }
  // At a flank it is free one way only, and pressed against nothing.
  Mechanism m = pair(0);
  m.joints[3].coordinates[0].stop->lower = 0;
  const Solution s = settled(m);
  CHECK(s.stability_reason != StabilityReason::minimum);
  CHECK_FALSE(s.stable);
}

TEST_CASE("a branch over the load goes from flank to flank", "[backlash][branches]") {
  const ResponseDiagram d = follow_branches(pair(-5), "parameters.T", -5, 5);
  INFO(d.message);
  REQUIRE(d.branches.size() == 1);
  const auto& points = d.branches[0].points;
  CHECK(points.front().parameter == -5);
  CHECK(points.back().parameter == 5);
  for (const ResponsePoint& p : points) {
    CAPTURE(p.parameter);
    const double at = value(p.coordinates, "play");
    if (std::abs(p.parameter) > 1e-9)
      CHECK(std::abs(at - on_flank(p.parameter)) < 1e-12);
    else
      CHECK(std::abs(at) <= play / 2 + 1e-12);
  }
}

TEST_CASE("a motion comes to rest on the flank that the load is on", "[backlash]") {
  for (const double torque : {3., -1.}) {
    const Mechanism m = pair(torque);
    const Solution s = settled(m);
    const Run run = simulate(m, lasting(12, Integrator::automatic, 1e-10));
    check_sound(run, 1e-7);
    CHECK(find_settled(run, s, 1e-7).time.has_value());
  }
}

TEST_CASE("a pinion driven by torque finds its speed through the play", "[backlash]") {
  for (const double torque : {2., -2., 0.}) {
    CAPTURE(torque);
    Mechanism m = pair(torque);
    m.joints[0].coordinates[0].drive->torque = 4;
    m.joints[0].formulas = {{"drive.torque", "4 N m - 0.2 N m s*rate(in)"}};
    const Solution s = settled(m);
    // 4 - 0.2 w + ratio T = 0.
    REQUIRE(coordinate(s, "in").speed);
    CHECK_THAT(*coordinate(s, "in").speed, WithinRel((4 + ratio * torque) / 0.2, 1e-12));
    if (torque != 0)
      CHECK_THAT(value(s, "play"), WithinRel(on_flank(torque), 1e-12));
    else
      CHECK(s.neutral == std::vector<std::string>{"play"});
  }
}

TEST_CASE("in a train each mesh lies on the flank of what it passes on", "[backlash]") {
  // The second wheel's rim turns as the first rim does, in it a hub as the first wheel in its rim, and in
  // that the wheel with its own play.
  const double width = 0.04, stiffness = 9000, second = -0.4;
  const Vec3 at(0.8, 0, 0);
  for (const double first_load : {3., -1., 0.5}) {
    Mechanism m = pair(first_load);
    m.bodies.push_back(body("rim2", 0, at));
    m.bodies.push_back(body("hub2", 0, at));
    m.bodies.push_back(body("wheel2", 6, at, {0.2, 0.2, 0.3}));
    m.joints.push_back(revolute("out2", "ground", "rim2", at));
    m.joints.push_back(gear("teeth2", "out", "out2", second));
    m.joints.push_back(revolute("follow2", "rim2", "hub2", at));
    m.joints.push_back(gear("teeth2 again", "play", "follow2", second));
    m.joints.push_back(toothed("play2", "hub2", "wheel2", at, width, stiffness));
    m.forces.push_back(load_on("wheel2"));
    m.forces.back().vector = Vec3(0, 0, 2);
    const Solution s = settled(m);
    const double through = first_load + second * 2; // what the first mesh passes on
    CAPTURE(first_load, through, s.message);
    CHECK(s.stable == true);
    CHECK(s.iterations < 20);
    CHECK_THAT(value(s, "play2"), WithinRel(on_flank(2, width, stiffness), 1e-12));
    CHECK_THAT(value(s, "play"), WithinRel(on_flank(through), 1e-12));
    CHECK_THAT(value(s, "follow2"), WithinRel(second * on_flank(through), 1e-12));
    CHECK_THAT(s.drive_torques.at(0).value, WithinRel(-ratio * through, 1e-11));
    const Run run = simulate(m, lasting(30, Integrator::automatic, 1e-10));
    CHECK(find_settled(run, s, 1e-6).time.has_value());
  }
}
