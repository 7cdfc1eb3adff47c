// Bodies and coordinates without mass: first-order motion, standing balance, and what nothing acts on.
#include "tests/engine/dynamics_runs.hpp"

#include <unsupported/Eigen/MatrixFunctions>

using namespace flyball;
using namespace flyball::test;

namespace {

// Blocks in a row along x, each on the one before; the first on ground.
Mechanism train(const std::vector<double>& masses) {
  Mechanism m;
  std::string before = "ground";
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const std::string name = "b" + std::to_string(i), slide = "x" + std::to_string(i);
    m.bodies.push_back(body(name, masses[i], {static_cast<double>(i), 0, 0}));
    m.joints.push_back(prismatic(slide, before, name, {static_cast<double>(i), 0, 0}, {1, 0, 0}));
    before = name;
  }
  return m;
}

} // namespace

TEST_CASE("a spring draws a massless slider through a damper: motion of first order") {
  Mechanism m = train({0});
  m.joints[0] = dampened(sprung(m.joints[0], 30, 0.4), 6);
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(m, lasting(1, method, 1e-11));
    check_sound(run);
    for (std::size_t i = 0; i < run.time.size(); ++i)
      CHECK(std::abs(track(run, "x0").value[i] - 0.4 * (1 - std::exp(-5 * run.time[i]))) < 1e-9);
    CHECK(std::abs(track(run, "x0").rate[0] - 2) < 1e-12);
    CHECK(std::abs(run.energy.dissipated.back() + run.energy.potential.back() - 30 * 0.4 * 0.4 / 2) < 1e-8);
  }
}

TEST_CASE("two springs with nothing between them are one") {
  Mechanism m = train({0, 0.5});
  m.joints[0] = sprung(m.joints[0], 100, 0.2);
  m.joints[1] = sprung(m.joints[1], 300, -0.1);
  const double together = 100. * 300 / 400, w = std::sqrt(together / 0.5);
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(m, lasting(2, method, 1e-11));
    check_sound(run, 1e-6);
    for (std::size_t i = 0; i < run.time.size(); ++i) {
      const double x = 0.1 * (1 - std::cos(w * run.time[i])); // of the mass
      const double middle = (100 * 0.2 + 300 * (x + 0.1)) / 400;
      CHECK(std::abs(track(run, "x0").value[i] - middle) < 1e-7);
      CHECK(std::abs(track(run, "x0").value[i] + track(run, "x1").value[i] - x) < 1e-7);
    }
    // On the way, not only the place is balanced but the rate follows.
    const std::size_t at = run.time.size() / 3;
    CHECK(std::abs(track(run, "x0").rate[at] - 0.75 * 0.1 * w * std::sin(w * run.time[at])) < 1e-6);
  }
}

TEST_CASE("a spring and a damper in series hold a mass") {
  // c y' = k (x - y), m x'' = -k (x - y) - k0 (x - 1)
  const double mass = 2, k = 50, c = 7, k0 = 20;
  Mechanism m = train({0, mass});
  m.joints[0] = dampened(m.joints[0], c);
  m.joints[1] = sprung(m.joints[1], k);
  Force spring; // on the mass from ground
  spring.name = "far";
  spring.bodies = {"ground", "b1"};
  spring.points = {Vec3(-9, 0, 0), Vec3(1, 0, 0)};
  spring.stiffness = k0;
  spring.free_length = 11;
  m.forces = {spring};
  Eigen::Matrix4d a; // of x, x', y, 1
  a << 0, 1, 0, 0, -(k + k0) / mass, 0, k / mass, k0 / mass, k / c, 0, -k / c, 0, 0, 0, 0, 0;
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(m, lasting(3, method, 1e-11));
    check_sound(run);
    double worst = 0;
    for (std::size_t i = 0; i < run.time.size(); i += 25) {
      const Eigen::Vector4d z = (a * run.time[i]).exp() * Eigen::Vector4d(0, 0, 0, 1);
      worst = std::max({worst, std::abs(track(run, "x0").value[i] - z[2]),
                        std::abs(track(run, "x0").value[i] + track(run, "x1").value[i] - z[0])});
    }
    CHECK(worst < 1e-8);
  }
}

TEST_CASE("what has no mass and feels nothing stays against its parent") {
  Mechanism m = conical(0.5, 0.1, 4, 0.5);
  m.bodies.push_back(body("flag", 0, {0.1, -0.3, 0.2}));
  m.joints.push_back(revolute("flutter", "bob", "flag", {0.1, -0.3, 0}, {1, 0, 0}));
  const Run run = simulate(m, lasting(1));
  check_sound(run);
  for (const double x : track(run, "flutter").value)
    CHECK(x == track(run, "flutter").value[0]);
  // And changes nothing.
  m.bodies.pop_back();
  m.joints.pop_back();
  CHECK(std::abs(last(simulate(m, lasting(1)), "swing") - last(run, "swing")) < 1e-8);
}

TEST_CASE("a massless universal cross and massless rods in a loop are as nothing") {
  // The pendulum of a spherical joint, and the same in a massless cross.
  Mechanism ball;
  ball.gravity = {0, -standard_gravity, 0};
  ball.bodies = {body("bob", 1, {0.3, -0.4, 0}, {0.01, 0.02, 0.01})};
  ball.joints = {joint(JointType::universal, "hang", "ground", "bob", {0, 0, 0}, {1, 0, 0})};
  ball.joints[0].axis2 = {0, 0, 1};
  Mechanism cross = ball;
  cross.bodies.push_back(body("cross", 0, {0, 0, 0}));
  cross.joints = {revolute("outer", "ground", "cross", {0, 0, 0}, {1, 0, 0}),
                  revolute("inner", "cross", "bob", {0, 0, 0}, {0, 0, 1})};
  const Run a = simulate(ball, kicked(lasting(2), "hang.0", 1.5));
  const Run b = simulate(cross, kicked(lasting(2), "outer", 1.5));
  check_sound(a);
  check_sound(b);
  CHECK((poses_at(a, 2)[0].position - poses_at(b, 2)[0].position).norm() < 1e-8);

  Mechanism governor = shipped("governor");
  for (Body& body : governor.bodies)
    if (body.name == "collar") {
      body.mass = 0;
      body.inertia = {};
    }
  check_sound(simulate(governor, lasting(1)));
}

TEST_CASE("the limit of vanishing mass is the massless motion") {
  // A damped massless slider on a swinging, driven body: with 1e-9 kg it moves alike after the first instant.
  const auto scene = [](double mass) {
    Mechanism m = conical(0.6, 0.1, 3, 0.4);
    m.bodies.push_back(body("bead", mass, {0.2, -0.3, 0}));
    m.joints.push_back(
        dampened(sprung(prismatic("bead", "bob", "bead", {0.2, -0.3, 0}, {1, 0, 0}), 40, 0.05), 4));
    Force pull;
    pull.name = "pull";
    pull.type = ForceType::force;
    pull.body = "bead";
    pull.vector = {0, -3, 0};
    m.forces = {pull};
    return m;
  };
  const Run none = simulate(scene(0), lasting(1.5, Integrator::bdf));
  const Run little = simulate(scene(1e-9), lasting(1.5, Integrator::bdf));
  check_sound(none, 1e-6);
  check_sound(little, 1e-6);
  for (const char* joint : {"swing", "bead"})
    for (std::size_t i = 5; i < none.time.size(); ++i)
      CHECK(std::abs(track(none, joint).value[i] - track(little, joint).value[i]) < 1e-6);
}

TEST_CASE("a massless slider meets a stop") {
  // Drawn by its spring through the damper to 0.4, stopped softly at 0.1: equilibrium between the two.
  Mechanism m = train({0});
  m.joints[0] = dampened(sprung(m.joints[0], 30, 0.4), 6);
  m.joints[0].coordinates[0].stop = Stop{{}, 0.1, 90};
  const Run run = simulate(m, lasting(3));
  check_sound(run);
  REQUIRE(run.stops.size() == 1);
  CHECK(run.stops[0].upper);
  CHECK(std::abs(run.stops[0].time - std::log(4. / 3) / 5) < 1e-8);
  const double rest = (30 * 0.4 + 90 * 0.1) / 120;
  CHECK(std::abs(last(run, "x0") - (rest - (rest - 0.1) * std::exp(-20 * (3 - run.stops[0].time)))) < 1e-8);
}

TEST_CASE("where nothing is free, drives turn and nothing else") {
  Mechanism m;
  m.bodies = {spindle()};
  m.joints = {spin(3)};
  for (const Integrator method : all_integrators) {
    const Run run = simulate(m, lasting(1, method));
    check_sound(run);
    CHECK(run.drives.at(0).torque.back() == 0);
    CHECK(last(run, "spin") == 3);
  }
}

TEST_CASE("what stands in balance starts from there, also beyond a stop or right at it") {
  // Two springs with a massless block between, that rests at or beyond the stop it was drawn before.
  for (const double free : {0., 0.2}) {
    CAPTURE(free);
    Mechanism m = train({0, 0.5});
    m.joints[0] = sprung(m.joints[0], 100, 0.4);
    m.joints[0].coordinates[0].stop = Stop{{}, 0.1, 200};
    m.joints[1] = sprung(m.joints[1], 100, free);
    for (const Integrator method : all_integrators) {
      CAPTURE(word(method));
      const Run run = simulate(m, lasting(1, method, 1e-11));
      check_sound(run);
      double worst = 0;
      for (std::size_t i = 0; i < run.time.size(); ++i) {
        const double x = track(run, "x0").value[i], y = track(run, "x1").value[i];
        worst = std::max(worst, std::abs(100 * (x - 0.4) + 200 * std::max(0., x - 0.1) - 100 * (y - free)));
      }
      CHECK(worst < 1e-8);
      CHECK(std::abs(track(run, "x0").value[0] - (free == 0 ? 0.15 : 0.1)) < 1e-12);
    }
  }
}
