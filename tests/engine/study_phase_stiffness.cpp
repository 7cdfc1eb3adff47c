// Steady states in which the angle of a shaft whose speed is found matters: it stands, or turns as fast as
// another that it is tied to by a force.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/linear_model.hpp"
#include "tests/catch.hpp"
#include "tests/engine/coupled_shafts.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

// 1 kg at 0.3 m above or below a hinge.
constexpr double arm = 0.3, inertia = 0.01 + arm * arm, weight = standard_gravity * arm;
Mechanism pendulum(Joint hinge, bool above) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("bob", 1, {0, above ? arm : -arm, 0}, {0.01, 0.01, 0.01})};
  m.joints = {std::move(hinge)};
  validate(m);
  return m;
}

constexpr double first = 0.1, second = 0.2, damping = 0.2; // of shafts()

// Where det [I1 s^2 + c s + k, -k; -k, I2 s^2 + c s + k] = 0 but for the turn of both together.
Complex shafts_left(Complex s, double k) {
  return first * second * s * s * s + damping * (first + second) * s * s +
         (damping * damping + k * (first + second)) * s + 2 * damping * k;
}

} // namespace

TEST_CASE("a pendulum whose hinge has a torque at rest falls or hangs", "[phase]") {
  const bool above = GENERATE(true, false);
  const Mechanism m = pendulum(torque_driven(hinge("p", "ground", "bob"), 1, "-0.05 N m s * rate(p)"), above);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(coordinate(s, "p").speed.value(), WithinAbs(0, 1e-12));
  CHECK(s.stable == !above);
  REQUIRE(s.eigenvalues);
  REQUIRE(s.eigenvalues->size() == 2);
  for (const Complex x : *s.eigenvalues)
    CHECK(std::abs(inertia * x * x + 0.05 * x + (above ? -weight : weight)) < 1e-11 * weight);
  // The motion agrees.
  SimulationOptions run;
  run.duration = 60;
  run.kick = {{"p", 0.01}};
  const Run motion = simulate(m, run);
  REQUIRE(motion.status == RunStatus::completed);
  CHECK_THAT(motion.coordinates[0].value.back(), WithinAbs(above ? M_PI : 0, 1e-4));
}

TEST_CASE("a chain whose first hinge has a torque at rest hangs by its energy", "[phase]") {
  constexpr int count = 30; // links, more than have their eigenvalues asked for alone
  const bool above = GENERATE(true, false);
  CAPTURE(above);
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  const double length = (above ? 1. : -1.) / count, mass = 1. / count;
  for (int i = 0; i < count; ++i) {
    const std::string name = "b" + std::to_string(i), before = "b" + std::to_string(i - 1);
    m.bodies.push_back(body(name, mass, {0, length * (i + 0.5), 0},
                            {mass * length * length / 12, 0, mass * length * length / 12}));
    const Joint joint =
        revolute("j" + std::to_string(i), i == 0 ? "ground" : before, name, {0, length * i, 0}, {0, 0, 1});
    m.joints.push_back(i == 0 ? torque_driven(joint, 0.1, "-0.05 N m s * rate(j0)") : dampened(joint, 0.001));
  }
  validate(m);
  SolveOptions nearest;
  nearest.nearest = true;
  const Solution s = Analysis(m).solve(nearest);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == !above);
  CHECK(s.stability_reason == (above ? StabilityReason::unstable : StabilityReason::minimum));
  REQUIRE(s.eigenvalues);
  double most = -1e9;
  for (const Complex x : *s.eigenvalues)
    most = std::max(most, x.real());
  CHECK((most > 0) == above);
}

TEST_CASE("a torque that just holds a pendulum sideways holds it at no other angle", "[phase]") {
  Joint joint = torque_driven(hinge("p", "ground", "bob"), 0.5, "2.941995 N m - 0.05 N m s * rate(p)");
  Mechanism m = pendulum(joint, true);
  m.bodies[0].position = {-arm, 0, 0}; // weight turns it forward by 2.941995 N m
  m.joints[0].formulas[0].text = "-2.941995 N m - 0.05 N m s * rate(p)";
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  if (s.status == Status::converged) CHECK(s.stable != true);
}

TEST_CASE("a spring between two shafts that turn alike holds or tips them", "[phase]") {
  const bool opposite = GENERATE(true, false);
  const Mechanism m = shafts(opposite);
  const double length = std::sqrt(0.25 + (opposite ? 0.36 : 0)), free = opposite ? 0.1 : 0.2;
  const double k = (opposite ? -1 : 1) * 50 * (length - free) * 0.09 / length;
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(coordinate(s, "p").speed.value(), WithinRel(10, 1e-12));
  CHECK(s.stable == !opposite);
  REQUIRE(s.eigenvalues);
  REQUIRE(s.eigenvalues->size() == 3);
  for (const Complex x : *s.eigenvalues)
    CHECK(std::abs(shafts_left(x, k)) < 1e-11 * std::pow(std::abs(x), 3));
  // A linear model has them, and the turn of both together.
  const LinearModel model =
      linearize(m, std::vector<std::string>{"torque(p)"}, std::vector<std::string>{"rate(q)"});
  INFO(model.refusal);
  REQUIRE(model.poles.size() == 4);
  int together = 0;
  for (const Complex x : model.poles)
    if (std::abs(x) < 1e-9)
      ++together;
    else
      CHECK(std::abs(shafts_left(x, k)) < 1e-9 * std::pow(std::abs(x), 3));
  CHECK(together == 1);
}

TEST_CASE("a body that stands still on a shaft that turns falls over as it would on the ground", "[phase]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {0, 0.1, 0.2}, {0.02, 0.02, 0.02})};
  m.joints = {driven(hinge("p", "ground", "a"), 10),
              torque_driven(hinge("q", "a", "b"), -10, "-0.01 N m s * (rate(q) + 10 rad/s)")};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == false);
  REQUIRE(s.eigenvalues);
  for (const Complex x : *s.eigenvalues)
    CHECK(std::abs(0.03 * x * x + 0.01 * x - 0.1 * standard_gravity) < 1e-10);
}

TEST_CASE("what is left to itself at rest above its hinge is not told to be stable", "[phase]") {
  Joint joint = hinge("p", "ground", "bob");
  Drive& drive = joint.coordinates[0].drive.emplace();
  drive.keeps = DriveKeeps::momentum;
  const Solution s = Analysis(pendulum(joint, true)).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_FALSE(s.stable);
  CHECK_THAT(s.message, ContainsSubstring("an angle matters"));
}
