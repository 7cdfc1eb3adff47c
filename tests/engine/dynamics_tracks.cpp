// What a run records beside its unknowns: coordinates of joints that close loops, and points of bodies.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/mechanism/error.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// The crank turns at 3 rad/s.
Mechanism slider_crank() {
  Mechanism m;
  m.name = "slider-crank";
  m.bodies = {body("crank", 1, {0.1, 0, 0}, {0.01, 0.01, 0.01}),
              body("rod", 1, {0.45, 0, 0}, {0.02, 0.02, 0.02}), body("piston", 2, {0.7, 0, 0})};
  m.joints = {driven(revolute("turn", "ground", "crank", {0, 0, 0}, Vec3::UnitZ()), 3),
              revolute("elbow", "crank", "rod", {0.2, 0, 0}, Vec3::UnitZ()),
              revolute("wrist", "rod", "piston", {0.7, 0, 0}, Vec3::UnitZ()),
              prismatic("stroke", "ground", "piston", {0.7, 0, 0}, Vec3::UnitX())};
  m.joints[3].coordinates[0].drawn = 2;
  m.joints[3].cut = true;
  return m;
}

// Two hinges on one line, one of them driven.
Mechanism door() {
  Mechanism m;
  m.name = "door";
  m.bodies = {body("door", 1, {0.5, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {driven(revolute("upper", "ground", "door", {0, 0, 1}, Vec3::UnitZ()), 4),
              revolute("lower", "door", "ground", {0, 0, 0}, Vec3::UnitZ())};
  m.joints[1].cut = true;
  return m;
}

} // namespace

TEST_CASE("a run records the stroke of a piston whose slide closes the loop") {
  const Run run = simulate(slider_crank(), lasting(3));
  REQUIRE(run.status == RunStatus::completed);
  const CoordinateTrack& stroke = track(run, "stroke");
  CHECK(stroke.dependent);
  REQUIRE(stroke.value.size() == run.time.size());
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    const double a = 3 * run.time[i], s = 0.2 * std::sin(a), across = std::sqrt(0.25 - s * s);
    CHECK(std::abs(stroke.value[i] - (2 + 0.2 * std::cos(a) + across - 0.7)) < 1e-9);
    CHECK(std::abs(stroke.rate[i] + 3 * s + 3 * s * 0.2 * std::cos(a) / across) < 1e-8);
  }
}

TEST_CASE(
    "angles that are measured go on beyond a turn, however few samples there are, and across a change") {
  const Mechanism m = door();
  for (const double rate : {100., 0.9}) {
    SimulationOptions options = lasting(5);
    options.rate = rate;
    const Run run = simulate(m, options);
    const CoordinateTrack& lower = track(run, "lower");
    for (std::size_t i = 0; i < run.time.size(); ++i) {
      CHECK(std::abs(lower.value[i] + 4 * run.time[i]) < 1e-9);
      CHECK(std::abs(lower.rate[i] + 4) < 1e-12);
    }
    const std::size_t last = run.time.size() - 2;
    SimulationOptions again = options;
    again.start = Start::state;
    again.state = state_at(run, last);
    const Run both = joined(run, last, simulate(m, again));
    for (std::size_t i = 0; i < both.time.size(); ++i)
      CHECK(std::abs(track(both, "lower").value[i] + 4 * both.time[i]) < 1e-9);
  }
}

TEST_CASE("points asked for are recorded with their velocities and accelerations") {
  Mechanism m;
  m.name = "pendulum";
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("arm", 1, {0.5, 0, 0}, {0.02, 0.02, 0.02})};
  m.joints = {revolute("hinge", "ground", "arm", {0, 0, 0}, Vec3::UnitY())};
  SimulationOptions options = lasting(1);
  options.points = {{"arm"}, {"arm", Vec3(1, 0.2, 0)}};
  const Run run = simulate(m, options);
  REQUIRE(run.points.size() == 2);
  const CoordinateTrack& hinge = track(run, "hinge");
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    const double a = hinge.value[i], w = hinge.rate[i];
    const double spin = 0.5 * standard_gravity * std::cos(a) / (0.02 + 0.25);
    for (const PointTrack& p : run.points) {
      const double length = p.point.at ? 1 : 0.5, side = p.point.at ? 0.2 : 0;
      const Vec3 out(std::cos(a), 0, -std::sin(a)), along(-std::sin(a), 0, -std::cos(a));
      CHECK((p.position[i] - length * out - Vec3(0, side, 0)).norm() < 1e-12);
      CHECK((p.velocity[i] - length * w * along).norm() < 1e-12);
      CHECK((p.acceleration[i] - length * (spin * along - w * w * out)).norm() < 1e-11);
    }
  }
  options.points = {{"leg"}};
  CHECK_THROWS_AS(simulate(m, options), SceneError);
}

TEST_CASE("accelerations are left out where bodies without mass have velocities that are no states") {
  Mechanism m;
  m.name = "light link";
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("arm", 1, {0.5, 0, 0}, {0.02, 0.02, 0.02}), body("flag", 0, {1.2, 0, 0})};
  m.joints = {revolute("hinge", "ground", "arm", {0, 0, 0}, Vec3::UnitY()),
              dampened(sprung(revolute("light", "arm", "flag", {1, 0, 0}, Vec3::UnitY()), 2, 0.3), 0.5)};
  SimulationOptions options = lasting(0.3);
  options.points = {{"flag"}};
  const Run run = simulate(m, options);
  CHECK(run.points[0].acceleration.empty());
  REQUIRE(run.points[0].velocity.size() == run.time.size());
  // Velocities are rates of the positions all the same.
  for (std::size_t i = 1; i + 1 < run.time.size(); ++i) {
    const Vec3 rate =
        (run.points[0].position[i + 1] - run.points[0].position[i - 1]) / (run.time[i + 1] - run.time[i - 1]);
    CHECK((rate - run.points[0].velocity[i]).norm() < 1e-2 * (1 + rate.norm()));
  }
}
