// Stick and slip in the motion, against closed forms.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/report/holding.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Run run_of(const Mechanism& m, SimulationOptions options) {
  const Run run = simulate(m, options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  return run;
}

double energy_error(const Run& run) {
  double most = 0;
  for (const double error : run.energy.balance)
    most = std::max(most, std::abs(error));
  return most;
}

} // namespace

TEST_CASE("a block on a spring loses 2 F / k a half swing and stops at once") {
  const double k = 50, f = 4, half = std::numbers::pi / std::sqrt(k / 2);
  for (const Integrator method : {Integrator::bdf, Integrator::adams, Integrator::runge_kutta}) {
    for (const double start : {0.5, -0.37, 0.31}) {
      CAPTURE(word(method), start);
      SimulationOptions options;
      options.duration = 8;
      options.method = method;
      options.at = {{"slide", start}};
      const Run run = run_of(block_on_spring(), options);
      double x = start;
      std::size_t turns = 0;
      while (std::abs(x) > f / k) {
        x = -x + (x > 0 ? 2 : -2) * f / k;
        ++turns;
        REQUIRE(run.frictions.size() >= turns);
        CHECK_THAT(run.frictions[turns - 1].time, WithinRel(static_cast<double>(turns) * half, 1e-7));
      }
      CHECK(run.frictions.size() == turns);
      CHECK(run.frictions.back().slips == 0);
      CHECK_THAT(run.coordinates[0].value.back(), WithinAbs(x, 1e-8));
      CHECK(run.coordinates[0].rate.back() == 0);
      CHECK(energy_error(run) < 1e-6);
      CHECK_THAT(run.energy.dissipated.back(), WithinRel(k / 2 * (start * start - x * x), 1e-7));
    }
  }
}

TEST_CASE("what is held stays where it is, exactly") {
  SimulationOptions options;
  options.duration = 3;
  const Run run = run_of(rubbing_pendulum(1.5, 0.1), options);
  CHECK(run.frictions.empty());
  for (const double value : run.coordinates[0].value)
    CHECK(value == 0.1);
}

TEST_CASE("of two joints that both take too much the one that the other's slip relieves stays") {
  // 11 N on 5.5 N, and on the second slide 16 N on 9 N: once that goes, what it carries along pulls the first
  // one forwards by its mass, which leaves less than 5.5 N to hold.
  const double first = 0.6, second = 1.4, pull = 16, holds = 9;
  const Mechanism m = read_scene(R"({"flyball": 2, "name": "Two slides", "gravity": [0, 0, 0],
    "bodies": [{"name": "a", "mass": 0.6, "position": [0, 0, 0]}, {"name": "b", "mass": 1.4, "position": [0, 0, 0]}],
    "joints": [{"name": "p", "type": "prismatic", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [1, 0, 0],
        "spring": {"force": 11}, "friction": {"limit": 5.5}},
      {"name": "q", "type": "prismatic", "bodies": ["a", "b"], "at": [0, 0, 0], "axis": [1, 0, 0],
        "spring": {"force": 16}, "friction": {"limit": 9}}]})");
  REQUIRE(11 - (pull - holds) < 5.5);
  REQUIRE((11 - 5.5) / (first + second) * second < pull - holds);
  SimulationOptions options;
  options.duration = 0.5;
  const Run run = run_of(m, options);
  CHECK(run.coordinates[0].value.back() == 0);
  CHECK_THAT(run.coordinates[1].value.back(), WithinRel(-(pull - holds) / second * 0.25 / 2, 1e-9));
}

TEST_CASE("a pendulum comes to rest within the band of steady states") {
  SimulationOptions options;
  options.duration = 20;
  options.at = {{"hinge", 1.2}};
  const Run run = run_of(rubbing_pendulum(1.5), options);
  CHECK(std::abs(run.coordinates[0].value.back()) <= std::asin(0.15));
  CHECK(run.coordinates[0].rate.back() == 0);
  CHECK(energy_error(run) < 1e-6);
}

TEST_CASE("a block on a rod that tilts begins to slide when its weight along it passes friction") {
  const double n = 0.3, m = 0.5, r = 0.4, f = 2, g = 9.80665;
  const Mechanism tilting = read_scene(R"({"flyball": 1, "name": "Tilting", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "rod", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
      {"name": "block", "mass": 0.5, "position": [0.4, 0, 0]}],
    "joints": [{"name": "tilt", "type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "drive": {"speed": 0.3}},
      {"name": "slide", "type": "prismatic", "bodies": ["rod", "block"], "at": [0.4, 0, 0],
      "axis": [1, 0, 0], "coordinate": 0.4, "friction": {"limit": 2}}]})");
  SimulationOptions options;
  options.duration = 2;
  const Run run = run_of(tilting, options);
  REQUIRE(run.frictions.size() == 1);
  CHECK(run.frictions[0].joint == "slide");
  CHECK(run.frictions[0].slips == -1);
  CHECK_THAT(run.frictions[0].time, WithinRel(std::asin((f + m * r * n * n) / (m * g)) / n, 1e-7));
  CHECK(energy_error(run) < 1e-6);
}

TEST_CASE("a linkage that comes to rest is held by the friction of all its joints") {
  Mechanism m = shipped("watt_governor");
  for (Joint& joint : m.joints)
    for (Coordinate& c : joint.coordinates)
      if (!c.drive) c.friction.emplace().limit = joint.type == JointType::prismatic ? 1.5 : 0.05;
  SimulationOptions options;
  options.duration = 5;
  const Run run = run_of(m, options);
  REQUIRE_FALSE(run.frictions.empty());
  std::vector<std::pair<std::string, double>> at;
  for (const CoordinateTrack& track : run.coordinates) {
    CHECK((track.driven || track.rate.back() == 0));
    if (!track.driven) at.emplace_back(track.joint, track.value.back());
  }
  const Holding holding = find_holding(m, at);
  INFO(holding.message);
  CHECK(holding.takes.value() < 1);
  CHECK(holding.takes.value() > 1e-6);
  CHECK(energy_error(run) < 1e-7);
}

TEST_CASE("friction in a governor's loops stops its collar within what it holds") {
  Mechanism m = shipped("governor");
  for (Joint& joint : m.joints)
    if (joint.name == "slide" || joint.name == "arm1" || joint.name == "arm2")
      joint.coordinates[0].friction.emplace().limit = joint.name == "slide" ? 5 : 0.2;
  SimulationOptions options;
  options.duration = 10;
  const Run run = run_of(m, options);
  REQUIRE_FALSE(run.frictions.empty());
  CHECK(run.frictions.back().slips == 0);
  for (const CoordinateTrack& track : run.coordinates)
    if (!track.driven) CHECK_THAT(track.rate.back(), WithinAbs(0, 1e-12));
  CHECK(energy_error(run) < 1e-6);
}

TEST_CASE("a part without mass begins where friction lets it stand, or as far as that lets it go") {
  // On springs of 50 N/m, slack at 0.2 m, and 80 N/m, slack at 0.1 m from a block.
  const Mechanism m = read_scene(R"({"flyball": 2, "name": "Massless link", "gravity": [0, -10, 0],
    "bodies": [{"name": "link", "mass": 0, "position": [0, 0, 0]},
      {"name": "block", "mass": 2, "position": [0.3, 0, 0]}],
    "joints": [{"name": "slide", "type": "prismatic", "bodies": ["ground", "link"], "at": [0, 0, 0],
        "axis": [1, 0, 0], "spring": {"stiffness": 50, "free": 0.2}, "friction": {"limit": 4}},
      {"name": "second", "type": "prismatic", "bodies": ["link", "block"], "at": [0.3, 0, 0],
        "axis": [1, 0, 0], "coordinate": 0.3, "spring": {"stiffness": 80, "free": 0.1}}]})");
  const auto begins = [&](double slide, double second) {
    SimulationOptions options;
    options.duration = 0.01;
    options.at = {{"slide", slide}, {"second", second}};
    return run_of(m, options).coordinates[0].value.front();
  };
  // 50 (0.2 - x) + 80 (X - x - 0.1) at x, X = x + second, is 3.2 N: it stands.
  CHECK(begins(0.28, 0.19) == 0.28);
  CHECK(begins(0.32, 0.15) == 0.32); // -2 N
  // 17.5 N and -7.2 N: it goes at once to where 4 N are left.
  CHECK_THAT(begins(0.17, 0.3), WithinRel((39.6 - 4) / 130, 1e-12));
  CHECK_THAT(begins(0.36, 0.11), WithinRel((39.6 + 4) / 130, 1e-12));
}
