// Every shipped scene in motion.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/support/campaign.hpp"

#include "engine/mechanism/error.hpp"

#include <filesystem>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("the scenes are all known here") {
  const std::vector<std::string> files = shipped_files();
  for (const std::string& file : files)
    CHECK(std::ranges::count(shipped_names, std::filesystem::path(file).stem().string()) == 1);
  CHECK(files.size() == shipped_names.size());
}

TEST_CASE("every scene moves soundly: energies balance and loops stay closed to rounding") {
  const int seconds = few_or_all(1, 2);
  for (const std::string& name : shipped_names)
    for (const bool damped : {true, false}) {
      CAPTURE(name, damped);
      SimulationOptions o = lasting(seconds);
      o.damped = damped;
      o.reactions = true;
      const Run run = simulate(shipped(name), o);
      // The clutch's friction is steep, with a corner where the shoes come to the drum.
      check_sound(run, name == "centrifugal_clutch" ? 1e-5 : 1e-7);
      CHECK(run.time.size() == 1 + 100 * static_cast<std::size_t>(seconds));
      CHECK(run.time.back() == seconds);
      CHECK(run.statistics.correction < 1e-7);
      if (!damped && !run.energy.jacobi.empty()) CHECK(jacobi_drift(run) < 1e-7);
    }
}

TEST_CASE("arms that are stretched out are passed straight on, wherever the steps fall") {
  // Both come to their dead points at once, where one could go back as the other goes on.
  const Mechanism governor = shipped("governor_engine");
  for (int i = 0; i < 16; ++i) {
    SimulationOptions o = undamped(lasting(0.6, Integrator::automatic, 1e-9 * std::pow(0.8, i)));
    CAPTURE(o.tolerance);
    const Run run = simulate(governor, o);
    check_sound(run);
    CHECK(last(run, "arm1") > 2);
    CHECK(std::abs(last(run, "arm1") - last(run, "arm2")) < 1e-6);
  }
}

TEST_CASE("two integrators agree on every scene") {
  for (const std::string& name : shipped_names) {
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Run a = simulate(m, lasting(0.4, Integrator::runge_kutta, 1e-11));
    const Run b = simulate(m, lasting(0.4, Integrator::bdf, 1e-11));
    check_sound(a);
    check_sound(b);
    REQUIRE(a.time == b.time);
    double worst = 0;
    for (std::size_t k = 0; k < a.coordinates.size(); ++k)
      for (std::size_t i = 0; i < a.time.size(); ++i)
        worst = std::max(worst, std::abs(a.coordinates[k].value[i] - b.coordinates[k].value[i]));
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("started in its steady state, every scene stays there") {
  for (const std::string& name : shipped_names) {
    if (moves_periodically(name)) continue;
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Solution steady = solve(m);
    REQUIRE(steady.status == Status::converged);
    SimulationOptions o = lasting(0.3);
    o.start = Start::equilibrium;
    o.reactions = true;
    const Run run = simulate(m, o);
    check_sound(run);
    for (std::size_t i = 0; i < run.time.size(); ++i)
      CHECK(distance_from(run, i, steady) < 1e-9);
    // And there asks its drives and joints for what the direct solution says.
    double size = 1;
    for (const Reaction& r : steady.reactions)
      size = std::max({size, r.force.norm(), r.torque.norm()});
    REQUIRE(run.drives.size() == steady.drive_torques.size());
    for (std::size_t d = 0; d < run.drives.size(); ++d)
      CHECK(std::abs(run.drives[d].torque.front() - steady.drive_torques[d].value) < 1e-8 * size);
    for (const ReactionTrack& r : run.reactions) {
      const auto there = std::ranges::find(steady.reactions, r.joint, &Reaction::joint);
      REQUIRE(there != steady.reactions.end());
      CHECK((r.force.front() - there->force).norm() < 1e-8 * size);
      CHECK((r.torque.front() - there->torque).norm() < 1e-8 * size);
    }
  }
}

TEST_CASE("what has no equations of motion is refused in a sentence that names it") {
  // A drag alone, and quadratic, on what has no mass: its velocity would be no smooth function of the forces.
  Mechanism m = conical(1, 0, 2, 0.3, 0);
  Force drag;
  drag.name = "air";
  drag.type = ForceType::drag;
  drag.body = "bob";
  drag.quadratic = 1;
  m.forces = {drag};
  CHECK_THROWS_WITH(simulate(m, lasting(1)), ContainsSubstring("swing"));
  // A force on what has neither mass nor anything that holds it.
  m.forces[0].type = ForceType::force;
  m.forces[0].vector = {1, 0, 0};
  m.forces[0].body = "bead";
  m.bodies.push_back(body("bead", 0, {0, 0, 0}));
  m.joints.push_back(prismatic("slip", "ground", "bead", {0, 0, 0}, {1, 0, 0}));
  m.bodies[1].mass = 1;
  CHECK_THROWS_WITH(simulate(m, lasting(1)),
                    ContainsSubstring("slip") && ContainsSubstring("resisted by nothing"));
  // Loops that cannot follow their drives: a rigid triangle between two.
  Mechanism stuck;
  stuck.bodies = {body("a", 1, {0, 0, 0}, {1, 1, 1}), body("b", 1, {1, 0, 0}, {1, 1, 1})};
  stuck.joints = {driven(revolute("first", "ground", "a", {0, 0, 0}, {0, 0, 1}), 1),
                  revolute("second", "ground", "b", {1, 0, 0}, {0, 0, 1}),
                  joint(JointType::fixed, "weld", "a", "b", {0.5, 0, 0})};
  CHECK_THROWS_AS(simulate(stuck, lasting(1)), SceneError);
}
