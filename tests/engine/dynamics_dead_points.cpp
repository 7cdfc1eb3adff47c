// Friction of a slide at the dead centres of its crank, where the slide stands still and turns back: against
// the work that friction does on its way.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pi = std::numbers::pi, crank = 0.1, link = 0.3;

Run run_of(const Mechanism& m, const SimulationOptions& options) {
  const Run run = simulate(m, options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  return run;
}

const CoordinateTrack& track(const Run& run, const std::string& joint) {
  const auto found = std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
  REQUIRE(found != run.coordinates.end());
  return *found;
}

// m, of the slide from its outer dead centre, where the crank is at `a` (rad).
double way(double a) {
  return crank + link - crank * std::cos(a) - std::sqrt(link * link - std::pow(crank * std::sin(a), 2));
}

// m, that the slide has come since then, there and back.
double distance_gone(double a) {
  const double turns = std::floor(std::abs(a) / pi), rest = std::abs(a) - turns * pi;
  const bool inwards = static_cast<long>(turns) % 2 == 0;
  return 2 * crank * turns + (inwards ? way(rest) : 2 * crank - way(pi - rest));
}

// All that is lost is lost to friction (N), on the slide's whole way from the outer dead centre on.
void check_friction(const Run& run, double limit) {
  const CoordinateTrack& a = track(run, "a");
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    CAPTURE(run.time[i], a.value[i]);
    CHECK_THAT(run.energy.dissipated[i], WithinAbs(limit * distance_gone(a.value[i]), 1e-6));
    CHECK(std::abs(run.energy.balance[i]) < 1e-6);
  }
}

Mechanism flat_slider_crank(double limit, const std::string& gravity, const std::string& crank_extra = "") {
  return read_scene(R"({"flyball": 1, "name": "Flat", "gravity": )" + gravity + R"(,
    "bodies": [{"name": "crank", "mass": 1, "position": [0.05, 0, 0], "inertia": [0.001, 0.001, 0.002]},
      {"name": "rod", "mass": 0.5, "position": [0.25, 0, 0], "inertia": [0.0001, 0.004, 0.004]},
      {"name": "piston", "mass": 0.8, "position": [0.4, 0, 0]}],
    "joints": [
      {"name": "a", "type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1])" +
                    crank_extra + R"(},
      {"name": "b", "type": "revolute", "bodies": ["crank", "rod"], "at": [0.1, 0, 0], "axis": [0, 0, 1]},
      {"name": "c", "type": "revolute", "bodies": ["rod", "piston"], "at": [0.4, 0, 0], "axis": [0, 0, 1]},
      {"name": "d", "type": "prismatic", "bodies": ["ground", "piston"], "at": [0.4, 0, 0],
        "axis": [1, 0, 0], "friction": {"limit": )" +
                    std::to_string(limit) + R"(}}]})");
}

} // namespace

TEST_CASE("a crank kicked at the dead centre is braked by its slide from there on", "[dead points]") {
  for (const Integrator method : {Integrator::runge_kutta, Integrator::bdf}) {
    for (const double kick : {9., -9., 20.}) {
      CAPTURE(word(method), kick);
      SimulationOptions options;
      options.method = method;
      options.duration = 3;
      options.tolerance = 1e-9;
      options.kick = {{"a", kick}};
      const Run run = run_of(flat_slider_crank(1, "[0, 0, 0]"), options);
      check_friction(run, 1);
      REQUIRE_FALSE(run.frictions.empty());
      CHECK(run.frictions.back().slips == 0); // it comes to rest
      CHECK_THAT(track(run, "a").rate.back(), WithinAbs(0, 1e-9));
      // At the dead centres it turns round, one after the other.
      const CoordinateTrack& a = track(run, "a");
      const auto passed = static_cast<std::size_t>(std::abs(a.value.back()) / pi);
      REQUIRE(run.frictions.size() == passed + 1);
      for (std::size_t i = 0; i < passed; ++i)
        CHECK(run.frictions[i].slips == (i % 2 == 0 ? 1 : -1));
      CHECK(passed >= 1);
    }
  }
}

TEST_CASE("a slide that keeps a kicked crank from going on holds it", "[dead points]") {
  SimulationOptions options;
  options.duration = 20;
  options.kick = {{"a", 3}};
  const Run run = run_of(rubbing_slider_crank(20), options);
  REQUIRE(run.frictions.size() == 1);
  CHECK(run.frictions[0].slips == 0);
  check_friction(run, 20);
  // All of the kick and of the weights' way down is lost on the way to where it stops.
  const double a = track(run, "a").value.back(), g = 9.80665;
  CHECK_THAT(0.5 * (0.002 + 1 * crank * crank) * 9 + g * (crank * (1 - std::cos(a)) + 0.8 * way(a)),
             WithinRel(20 * way(a), 1e-6));
}

TEST_CASE("a crank that falls from the dead centre is braked from there on", "[dead points]") {
  for (const double down : {-1., 1.}) {
    CAPTURE(down);
    SimulationOptions options;
    options.duration = 0.4; // before it swings back
    options.tolerance = 1e-9;
    const std::string gravity = "[0, " + std::to_string(down * 9.8) + ", 0]";
    check_friction(run_of(flat_slider_crank(1, gravity), options), 1);
    // The same where the crank's own friction gives way first.
    const Run run = run_of(flat_slider_crank(1, gravity, R"(, "friction": {"limit": 0.1})"), options);
    const double at = track(run, "a").value.back();
    CHECK(std::abs(at) > 0.1);
    CHECK_THAT(run.energy.dissipated.back(), WithinAbs(way(at) + 0.1 * std::abs(at), 1e-7));
  }
}

TEST_CASE("at rest at the dead centre with nothing to move it a crank stays there", "[dead points]") {
  SimulationOptions options;
  options.duration = 2;
  const Run run = run_of(flat_slider_crank(1, "[0, 0, 0]"), options);
  CHECK(track(run, "a").value.back() == 0);
  CHECK(track(run, "d").value.back() == 0);
}

TEST_CASE("a torque that grows on a crank at the dead centre finds the friction of its slide",
          "[dead points]") {
  // A spring between the crank and a drum that turns: no torque at first, then ever more.
  const Mechanism m = read_scene(R"({"flyball": 1, "name": "Winding",
    "bodies": [{"name": "drum", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
      {"name": "crank", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
      {"name": "slider", "mass": 0.8, "position": [0.4, 0, 0]}],
    "joints": [{"name": "wind", "type": "revolute", "bodies": ["ground", "drum"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "drive": {"speed": 0.5}},
      {"name": "a", "type": "revolute", "bodies": ["drum", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "spring": {"stiffness": 2}},
      {"name": "d", "type": "prismatic", "bodies": ["ground", "slider"], "at": [0.4, 0, 0],
        "axis": [1, 0, 0], "friction": {"limit": 1}},
      {"name": "link", "type": "distance", "bodies": ["crank", "slider"],
        "points": [[0.1, 0, 0], [0.4, 0, 0]]}]})");
  SimulationOptions options;
  options.duration = 4;
  const Run run = run_of(m, options);
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    const double a = track(run, "wind").value[i] + track(run, "a").value[i];
    CAPTURE(run.time[i], a);
    REQUIRE(a < pi);
    CHECK_THAT(run.energy.dissipated[i], WithinAbs(way(a), 1e-6));
    CHECK(std::abs(run.energy.balance[i]) < 1e-6);
  }
  CHECK(run.energy.dissipated.back() > 0.05);
}

TEST_CASE("a governor's collar with friction passes where both arms hang and the loops are singular",
          "[dead points]") {
  Mechanism m = shipped("governor_engine");
  for (Joint& joint : m.joints)
    if (joint.name == "slide") joint.coordinates[0].friction.emplace().limit = 2;
  // Where it comes to rest does not depend on how it is computed, nor on where samples are taken.
  std::vector<double> angles;
  for (const Integrator method : {Integrator::runge_kutta, Integrator::bdf, Integrator::adams})
    for (const double rate : {1., 93., 400.}) {
      CAPTURE(word(method), rate);
      SimulationOptions options;
      options.duration = 60;
      options.method = method;
      options.rate = rate;
      const Run run = run_of(m, options);
      CHECK(run.statistics.singular_positions > 0);
      CHECK_THAT(track(run, "slide").rate.back(), WithinAbs(0, 1e-12));
      CHECK_THAT(run.energy.balance.back(), WithinAbs(0, 1e-4)); // of 3000 J
      angles.push_back(track(run, "spin").value.back());
    }
  for (const double angle : angles)
    CHECK_THAT(angle, WithinRel(angles.front(), 1e-7));
}
