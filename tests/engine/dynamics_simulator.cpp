// Runs as they are asked for: starts, slices, changes on the way, cancelling, and how they stop.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/mechanism/error.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

void check_equal(const Run& a, const Run& b) {
  REQUIRE(a.time == b.time);
  CHECK(a.states == b.states);
  CHECK(a.energy.balance == b.energy.balance);
  REQUIRE(a.coordinates.size() == b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    CHECK(a.coordinates[i].value == b.coordinates[i].value);
}

double largest_difference(const Run& a, const Run& b, std::size_t from = 0) {
  double worst = 0;
  for (std::size_t k = 0; k < a.coordinates.size(); ++k)
    for (std::size_t i = 0; i + from < a.time.size() && i < b.time.size(); ++i)
      worst = std::max(worst, std::abs(a.coordinates[k].value[i + from] - b.coordinates[k].value[i]));
  return worst;
}

// On a turntable without anything that holds it, it runs away as cosh.
Mechanism runaway() {
  Mechanism m;
  m.bodies = {spindle(), body("ring", 0.3, {0.2, 0, 0})};
  m.joints = {spin(30), prismatic("r", "spindle", "ring", {0.2, 0, 0}, {1, 0, 0})};
  m.joints[1].coordinates[0].drawn = 0.2;
  return m;
}

} // namespace

TEST_CASE("advancing in slices gives what one call gives") {
  for (const std::string name : {"pendulum", "governor", "ball_on_string"})
    for (const Integrator method : all_integrators) {
      CAPTURE(name, word(method));
      const Mechanism m = shipped(name);
      const SimulationOptions o = lasting(0.7, method);
      const Run whole = simulate(m, o);
      Simulator slices(m, o);
      for (const double until : {0.003, 0.011, 0.2, 0.2, 0.25, 0.6999, 0.7})
        CHECK(slices.advance(until));
      CHECK(std::abs(slices.time() - 0.7) < 1e-12);
      check_equal(whole, slices.run());
      CHECK(slices.run().statistics.steps == whole.statistics.steps);
    }
}

TEST_CASE("samples are where they were asked for") {
  const Mechanism m = shipped("pendulum");
  SimulationOptions o = lasting(0.25);
  o.rate = 7;
  Run run = simulate(m, o);
  CHECK(run.time.size() == 3); // 0, 1/7 and the end
  CHECK(run.time[1] == 1. / 7);
  CHECK(run.time[2] == 0.25);
  o.rate = 0;
  run = simulate(m, o);
  CHECK(run.time == std::vector<double>{0, 0.25});
  o.duration = 0;
  run = simulate(m, o);
  CHECK(run.time == std::vector<double>{0});
  CHECK(run.status == RunStatus::completed);
}

TEST_CASE("a run split at a saved state goes on as if it had not been") {
  for (const std::string& name : shipped_names) {
    if (name == "chain20") continue; // takes seconds, and shows no more
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Run whole = simulate(m, lasting(0.6, Integrator::runge_kutta, 1e-11));
    const SimulationState half = state_at(whole, 30);
    CHECK(half.time == whole.time[30]);
    SimulationOptions o = lasting(0.3, Integrator::runge_kutta, 1e-11);
    o.start = Start::state;
    o.state = half;
    const Run rest = simulate(m, o);
    check_sound(rest);
    CHECK(std::abs(rest.time.front() - 0.3) < 1e-15);
    CHECK(std::abs(rest.time.back() - 0.6) < 1e-12);
    CHECK(largest_difference(whole, rest, 30) < 1e-8);
    // The state comes back as it was given.
    const SimulationState again = state_at(rest, 0);
    REQUIRE(again.coordinates.size() == half.coordinates.size());
    for (std::size_t i = 0; i < half.coordinates.size(); ++i) {
      CHECK(std::abs(again.coordinates[i].value - half.coordinates[i].value) < 1e-12);
      CHECK(std::abs(again.coordinates[i].rate - half.coordinates[i].rate) < 1e-11);
    }
  }
  // With fixed steps to the last digits.
  const Mechanism m = shipped("pendulum");
  SimulationOptions o = lasting(0.5);
  o.fixed_step = 1. / 1024;
  o.rate = 64;
  const Run whole = simulate(m, o);
  o.start = Start::state;
  o.state = state_at(whole, 16);
  o.duration = 0.25;
  CHECK(largest_difference(whole, simulate(m, o), 16) < 1e-14);
  // And a state of something else is refused.
  CHECK_THROWS_WITH(simulate(shipped("governor"), o), ContainsSubstring("another mechanism"));
}

TEST_CASE("a start that loops share is met exactly, or refused") {
  const Mechanism m = shipped("governor");
  const Run run = simulate(m, starting_at(lasting(0.1), "arm1", 0.5));
  check_sound(run);
  CHECK(track(run, "arm1").value[0] == Approx(0.5).epsilon(1e-12));
  CHECK(track(run, "slide").value[0] > 0.08); // has come along
  try {
    simulate(m, starting_at(lasting(0.1), "slide", 3));
    FAIL("three metres along a spindle of a third of one");
  } catch (const SceneError& error) {
    CHECK_THAT(error.what(), ContainsSubstring("joints.slide"));
    CHECK_THAT(error.what(), ContainsSubstring("loops"));
  }
}

TEST_CASE("the starts") {
  const Mechanism m = shipped("pendulum");
  SimulationOptions o = lasting(0.1);
  Run run = simulate(m, o);
  CHECK(track(run, "theta").value[0] == 0);
  CHECK(track(run, "d").value[0] == 1.1);
  CHECK(track(run, "theta").rate[0] == 0);
  // Elsewhere, and with a kick.
  o = kicked(starting_at(o, "theta", 0.4), "d", -0.5);
  run = simulate(m, o);
  CHECK(track(run, "theta").value[0] == 0.4);
  CHECK(track(run, "d").rate[0] == -0.5);
  CHECK(track(run, "theta").rate[0] == 0);
  // Standing still in the world: the free bodies have no kinetic energy but what the crank forces on them.
  o = lasting(0.1);
  o.start = Start::drawn;
  run = simulate(m, o);
  check_sound(run);
  SimulationOptions rest = lasting(0.1);
  CHECK(run.energy.kinetic[0] < simulate(m, rest).energy.kinetic[0]);
  // With the governor closed, nothing but the spindle and what turns with it about its own axis.
  const Run still = simulate(shipped("governor"), o);
  check_sound(still);
  // The steady state with a kick goes back to it.
  o = kicked(lasting(3), "theta", 2);
  o.start = Start::equilibrium;
  run = simulate(m, o);
  CHECK(distance_from(run, 0, solve(m)) < 1e-12);
  CHECK(distance_from(run, 20, solve(m)) > 1e-3);
  CHECK(distance_from(run, run.time.size() - 1, solve(m)) < 1e-7);

  // Mistakes are told by name.
  CHECK_THROWS_WITH(simulate(m, kicked(lasting(1), "nothing", 1)), ContainsSubstring("nothing"));
  CHECK_THROWS_WITH(simulate(m, kicked(lasting(1), "spin", 1)), ContainsSubstring("driven"));
  CHECK_THROWS_AS(simulate(m, starting_at(lasting(1), "nothing", 1)), SceneError);
  o = lasting(1);
  o.start = Start::equilibrium;
  Mechanism slanted = shipped("conical_pendulum");
  slanted.gravity = {3, -9, 0};
  CHECK_THROWS_WITH(simulate(slanted, o), ContainsSubstring("no steady state to start from"));
}

TEST_CASE("numbers change on the way") {
  for (const std::string name : {"pendulum", "governor"}) {
    CAPTURE(name);
    const Mechanism m = shipped(name);
    Mechanism faster = m;
    set_parameter(faster, "joints.spin.drive.speed", name == "pendulum" ? 15 : 12);
    SimulationOptions o = lasting(1);
    Simulator simulator(m, o);
    simulator.advance(0.5);
    const SimulationState before = simulator.state();
    simulator.change(faster, true);
    simulator.advance(1);
    simulator.change(faster, false);
    CHECK(simulator.advance(1.5));
    const Run& run = simulator.run();
    CHECK_FALSE(run.damped);
    check_sound(run, 1e-6);
    CHECK(run.segments.size() == 3);
    REQUIRE(run.time.size() == 151);
    // Where it was, everything goes on; drives turn on from where they stood.
    for (const StateCoordinate& c : before.coordinates) {
      const CoordinateTrack& t = track(run, c.joint, c.index);
      CHECK(std::abs(t.value[50] - c.value) < 1e-14);
      CHECK(std::abs(t.value[51] - c.value - (t.driven ? t.rate[51] : c.rate) * 0.01) <
            0.05 * (1 + std::abs(c.rate)));
      if (t.driven) CHECK(t.rate[51] == (name == "pendulum" ? 15 : 12));
    }
    // The same as a new run from there.
    SimulationOptions fresh = lasting(0.5);
    fresh.start = Start::state;
    fresh.state = before;
    CHECK(largest_difference(run, simulate(faster, fresh), 50) < 1e-7);
    const std::vector<Pose> a = poses_at(run, 0.4999999), b = poses_at(run, 0.5000001);
    for (std::size_t i = 0; i < a.size(); ++i)
      CHECK((a[i].position - b[i].position).norm() < 1e-4);
    // No damper takes anything any more.
    CHECK(run.energy.dissipated[150] == run.energy.dissipated[101]);
  }
  Simulator simulator(shipped("pendulum"), lasting(1));
  simulator.advance(0.1);
  CHECK_THROWS_AS(simulator.change(shipped("governor"), true), SceneError);
  CHECK(simulator.advance(0.2)); // and goes on with what it had
}

TEST_CASE("a cancelled run keeps what it has and may be gone on with") {
  const Mechanism m = shipped("governor");
  std::atomic<bool> cancel = false;
  SimulationOptions o = lasting(1);
  o.cancel = &cancel;
  o.progress = [&](double t) {
    if (t > 0.4) cancel = true;
  };
  Simulator simulator(m, o);
  CHECK_FALSE(simulator.advance(1));
  CHECK(simulator.run().status == RunStatus::cancelled);
  CHECK_THAT(simulator.run().message, ContainsSubstring("Cancelled at t = 0.41 s"));
  CHECK(std::abs(simulator.time() - 0.41) < 1e-12);
  check_whole(simulator.run());
  cancel = false;
  while (!simulator.advance(1))
    cancel = false;
  CHECK(simulator.run().status == RunStatus::completed);
  check_equal(simulate(m, lasting(1)), simulator.run());
}

TEST_CASE("a run that runs away says when and what, and keeps what was well") {
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    Simulator simulator(runaway(), lasting(10, method));
    CHECK_FALSE(simulator.advance(10));
    const Run& run = simulator.run();
    CHECK(run.status == RunStatus::diverged);
    CHECK_THAT(run.message, ContainsSubstring("The motion stopped at t = 0."));
    CHECK_THAT(run.message, ContainsSubstring("r runs away"));
    check_whole(run);
    CHECK(run.time.size() > 50);
    for (std::size_t i = 0; i < run.time.size(); ++i)
      CHECK(std::abs(track(run, "r").value[i] / (0.2 * std::cosh(30 * run.time[i])) - 1) < 1e-5);
    const std::size_t samples = run.time.size();
    CHECK_FALSE(simulator.advance(20)); // it is over
    CHECK(simulator.run().time.size() == samples);
  }
  SimulationOptions few = lasting(10);
  few.max_steps = 100;
  const Run run = simulate(shipped("pendulum"), undamped(few));
  CHECK(run.status == RunStatus::diverged);
  CHECK_THAT(run.message, ContainsSubstring("100 steps"));
  check_whole(run);
}

TEST_CASE("poses between samples follow the motion") {
  const Mechanism m = shipped("pendulum");
  SimulationOptions coarse = lasting(0.5), fine = lasting(0.5);
  fine.rate = 1600;
  const Run a = simulate(m, coarse), b = simulate(m, fine);
  double worst = 0;
  for (std::size_t i = 0; i < b.time.size(); ++i) {
    const std::vector<Pose> between = poses_at(a, b.time[i]), exact = poses_at(b, b.time[i]);
    for (std::size_t k = 0; k < exact.size(); ++k)
      worst = std::max({worst, (between[k].position - exact[k].position).norm(),
                        between[k].rotation.angularDistance(exact[k].rotation)});
  }
  CHECK(worst < 2e-3); // of a motion of 224 rad/s, sampled 100 times a second
  CHECK(poses_at(a, -1)[1].position == poses_at(a, 0)[1].position);
  CHECK(poses_at(a, 9)[1].position == poses_at(a, 0.5)[1].position);
}

TEST_CASE("the settled detector") {
  const Mechanism m = shipped("pendulum");
  const Solution steady = solve(m);
  const Run run = simulate(m, lasting(4));
  const Settled early = find_settled(run, steady, 1e-3), late = find_settled(run, steady, 1e-7);
  REQUIRE(early.time);
  REQUIRE(late.time);
  CHECK(*early.time < *late.time);
  for (std::size_t i = 0; i < run.time.size(); ++i)
    if (run.time[i] >= *early.time) CHECK(distance_from(run, i, steady) <= 1e-3);
  const Settled never = find_settled(simulate(m, undamped(lasting(1))), steady);
  CHECK_FALSE(never.time);
  CHECK_THAT(never.message, ContainsSubstring("Not settled after 1 s: theta is "));
  CHECK_FALSE(runs_into(run, steady, steady));
  CHECK_FALSE(runs_into(run, solve(shipped("governor")), steady)); // of another mechanism
  CHECK_FALSE(find_settled(run, solve(shipped("governor"))).time);
}
