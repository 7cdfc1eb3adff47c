// The motion about steady states whose speeds are found: it has their coordinates, so that it stays there and
// its linear model is theirs, whatever holds the parts: against closed forms, and against the same parts on
// other joints.
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/linear_model.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

const std::string by_torque = R"x({"torque": "=2 N m - 0.2 N m s * rate(s)", "speed": 5})x";
const std::string by_momentum = R"({"keeps": "momentum", "speed": 10})";

// A body that slides on a shaft about z, held by a spring and a damper; the slide may be a joint of the tree
// or one that closes a loop, the body then hanging on nothing else.
Mechanism slide_on_shaft(const std::string& drive, bool cut) {
  return read_scene(R"({"flyball": 2, "name": "slide",
    "bodies": [{"name": "sh", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.2]},
      {"name": "ho", "mass": 0.5, "position": [0.3, 0, 0], "inertia": [0.03, 0.04, 0.05]}],
    "joints": [{"name": "s", "type": "revolute", "bodies": ["ground", "sh"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "drive": )" +
                    drive + R"(},
      {"name": "sl", "type": "prismatic", "bodies": ["sh", "ho"], "at": [0.3, 0, 0], "axis": [1, 0, 0])" +
                    (cut ? R"(, "cut": true)" : "") + R"(}],
    "forces": [{"type": "spring", "name": "k", "bodies": ["sh", "ho"],
      "points": [[0.1, 0, 0], [0.3, 0, 0]], "stiffness": 200, "free_length": 0.2, "damping": 1}]})");
}

// A body beside the axis of a shaft, in a bearing that resists all shifts and turns.
Mechanism body_in_bearing(const std::string& drive) {
  return read_scene(R"({"flyball": 2, "name": "bearing",
    "bodies": [{"name": "sh", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.2]},
      {"name": "ho", "mass": 0.5, "position": [0.05, 0, 0.1], "inertia": [0.03, 0.04, 0.05]}],
    "joints": [{"name": "s", "type": "revolute", "bodies": ["ground", "sh"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "drive": )" +
                    drive + R"(}],
    "forces": [{"type": "bearing", "name": "b", "bodies": ["sh", "ho"], "at": [0, 0, 0.1],
      "axis": [0, 0, 1],
      "stiffness": [[1000, 0, 0, 0, -200, 0], [0, 1000, 0, 200, 0, 0], [0, 0, 1000, 0, 0, 0],
        [0, 200, 0, 100, 0, 0], [-200, 0, 0, 0, 100, 0], [0, 0, 0, 0, 0, 100]],
      "damping": [[4, 0, 0, 0, 0, 0], [0, 4, 0, 0, 0, 0], [0, 0, 4, 0, 0, 0], [0, 0, 0, 0.1, 0, 0],
        [0, 0, 0, 0, 0.1, 0], [0, 0, 0, 0, 0, 0.1]]}]})");
}

// A disc in the air on a shaft at 20 rad/s, with a damper between them: 0.3 N m s against 0.09.
Mechanism disc_in_air() {
  return read_scene(R"({"flyball": 2, "name": "disc",
    "bodies": [{"name": "shaft", "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.02]},
      {"name": "disc", "mass": 1, "position": [0, 0, 0.1], "inertia": [0.01, 0.01, 0.02]}],
    "joints": [{"name": "shaft", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "drive": {"speed": 20}},
      {"name": "free", "type": "revolute", "bodies": ["shaft", "disc"], "at": [0, 0, 0.1], "axis": [0, 0, 1],
        "damping": 0.3}],
    "forces": [{"type": "drag", "name": "d1", "body": "disc", "at": [0.3, 0, 0.1], "linear": 0.5},
      {"type": "drag", "name": "d2", "body": "disc", "at": [-0.3, 0, 0.1], "linear": 0.5}]})");
}

LinearModel made(const Mechanism& m, const std::vector<std::string>& outputs) {
  const std::vector<std::string> inputs{"torque(s)"};
  LinearModel model = linearize(m, inputs, outputs, {});
  INFO(model.refusal);
  REQUIRE(model.refusal.empty());
  return model;
}

// How far a motion that starts in the steady state goes from it within `duration` (s).
double goes_astray(const Mechanism& m, double duration) {
  const Solution steady = Analysis(m).solve();
  INFO(steady.message);
  REQUIRE(steady.status == Status::converged);
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.duration = duration;
  const Run run = simulate(m, options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  double most = 0;
  for (std::size_t sample = 0; sample < run.time.size(); ++sample)
    most = std::max(most, distance_from(run, sample, steady));
  return most;
}

double sorted_difference(std::vector<Complex> a, const std::vector<Complex>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (const Complex& x : b) {
    const auto nearest = std::ranges::min_element(a, {}, [&](const Complex& y) { return std::abs(y - x); });
    most = std::max(most, std::abs(*nearest - x));
    a.erase(nearest);
  }
  return most;
}

} // namespace

TEST_CASE("what a spring holds on a shaft swings with the shaft's speed, cut or not", "[found]") {
  for (const std::string& drive : {by_torque, by_momentum})
    for (const bool cut : {false, true}) {
      CAPTURE(drive, cut);
      const Mechanism m = slide_on_shaft(drive, cut);
      const LinearModel model = made(m, {"rate(s)"});
      const double w = coordinate(model.steady, "s").speed.value(),
                   x = cut ? 0.3 + value(model.steady, "ho.free", 0) : 0.3 + value(model.steady, "sl");
      CHECK_THAT(0.5 * x * w * w, WithinRel(200 * (x - 0.3), 1e-12));
      // (I + m x^2) w' = -0.2 w - 2 m x v w, x' = v, m v' = m x w^2 - k (x - 0.3) - c v.
      const double inertia = 0.25 + 0.5 * x * x;
      Eigen::Matrix3d a;
      a << (drive == by_torque ? -0.2 : 0.) / inertia, 0, -x * w / inertia, //
          0, 0, 1,                                                          //
          2 * x * w, w * w - 400, -2;
      const Eigen::Vector3cd poles = a.eigenvalues();
      CHECK(sorted_difference(model.poles, {poles[0], poles[1], poles[2]}) < 1e-9);
      CHECK(goes_astray(m, 2) < 1e-8);
    }
}

TEST_CASE("Haug's governor with engine has the same linear model where its collar closes the loops",
          "[found]") {
  Mechanism m = shipped("governor_engine");
  const std::vector<std::string> inputs{"torque(spin)"}, outputs{"rate(spin)"};
  const LinearModel before = linearize(m, inputs, outputs, {});
  for (Joint& joint : m.joints)
    if (joint.name == "slide") joint.cut = true;
  const LinearModel after = linearize(m, inputs, outputs, {});
  INFO(before.refusal << after.refusal);
  REQUIRE((before.refusal.empty() && after.refusal.empty()));
  CHECK(sorted_difference(before.poles, after.poles) < 1e-8);
  CHECK_THAT(after.gain.value()(0, 0), WithinRel(before.gain.value()(0, 0), 1e-8));
}

TEST_CASE("a body in a bearing on a shaft goes round with it, whatever drives the shaft",
          "[found][bearing]") {
  for (const std::string& drive : {by_torque, by_momentum}) {
    CAPTURE(drive);
    const Mechanism m = body_in_bearing(drive);
    CHECK(goes_astray(m, 2) < 1e-7);
    const LinearModel model = made(m, {"rate(s)", "force(b)"});
    // Of which the steady state tells the same, but for the angle of the shaft.
    std::vector<Complex> wanted = model.steady.eigenvalues.value();
    std::vector<Complex> found = model.poles;
    const auto nothing = [](const Complex& x) { return std::abs(x) < 1e-6; };
    std::erase_if(wanted, nothing);
    std::erase_if(found, nothing);
    CHECK(sorted_difference(found, wanted) < 1e-6);
    CompareOptions options;
    options.tolerances = {1e-8};
    options.repeats = 1;
    options.durations = {30};
    options.integrators = {Integrator::runge_kutta};
    if (drive != by_torque) continue; // drawn at rest it has another momentum than in its steady state
    const Comparison comparison = compare(m, options);
    REQUIRE(comparison.best);
    CHECK(comparison.best->error < 1e-3); // its slowest motion dies out at 0.6 1/s
  }
}

TEST_CASE("a motion starts in a steady state where a part turns at a rate of its own", "[found][implied]") {
  const Mechanism m = disc_in_air();
  CHECK_THAT(coordinate(Analysis(m).solve(), "free").speed.value(), WithinRel(-1.8 / 0.39, 1e-12));
  CHECK(goes_astray(m, 3) < 1e-9);
  CompareOptions options;
  options.tolerances = {1e-8};
  options.repeats = 1;
  const Comparison comparison = compare(m, options);
  CHECK(comparison.complete);
  REQUIRE(comparison.best);
  CHECK(comparison.best->error < 1e-6);
}

TEST_CASE("a shaft whose torque is flat about its speed does not run away", "[found]") {
  const Mechanism m = read_scene(R"({"flyball": 2, "name": "flat",
    "bodies": [{"name": "r", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]}],
    "joints": [{"name": "s", "type": "revolute", "bodies": ["ground", "r"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "drive": {"torque": "=-1 N m * (rate(s) * 1 s - 2)^3", "speed": 1}}]})");
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.duration = 20;
  const Run run = simulate(m, options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK_THAT(run.coordinates[0].rate.back(), WithinAbs(2, 1e-4));
  // From rest: e = 2 - w has e' = -e^3, so that 1 / e^2 grows by 2 t.
  options.start = Start::drawn;
  const Run from_rest = simulate(m, options);
  REQUIRE(from_rest.status == RunStatus::completed);
  CHECK_THAT(from_rest.coordinates[0].rate.back(), WithinRel(2 - 1 / std::sqrt(0.25 + 40), 1e-7));
}

TEST_CASE("a comparison in which no motion comes to its end is not complete", "[found]") {
  CompareOptions options;
  options.tolerances = {1e-8};
  options.repeats = 1;
  options.max_steps = 3;
  const Comparison comparison = compare(shipped("pendulum"), options);
  CHECK(comparison.status == Status::converged);
  CHECK_FALSE(comparison.complete);
  CHECK_FALSE(comparison.best);
  CHECK_THAT(comparison.message, ContainsSubstring("No motion went on to its end"));
}
