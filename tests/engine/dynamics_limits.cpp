// Motions that would never come to an end, or cannot begin: limits of time, cancelling inside steps,
// refusals.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/mechanism/error.hpp"

#include <chrono>
#include <random>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const std::vector<std::string> endless{"motion_with_a_far_point", "motion_with_extreme_damping",
                                       "motion_of_a_string_held_far_away"};

// A chain whose masses, lengths, springs and dampers lie anywhere double precision can write them.
Mechanism extreme(unsigned seed) {
  std::mt19937 random(seed);
  const auto power = [&] { return std::pow(10., std::uniform_real_distribution<double>(-30, 30)(random)); };
  const auto chance = [&](double part) {
    return std::uniform_real_distribution<double>(0, 1)(random) < part;
  };
  Mechanism m = hanging_chain(3, 5);
  for (Body& b : m.bodies) {
    if (chance(0.3)) b.mass = power();
    if (chance(0.3)) b.mass = 0;
    if (chance(0.3)) b.inertia = {};
    if (chance(0.1)) b.position *= power();
  }
  for (std::size_t i = 1; i < m.joints.size(); ++i) {
    if (chance(0.3)) m.joints[i] = sprung(m.joints[i], power());
    if (chance(0.3)) m.joints[i] = dampened(m.joints[i], power());
    if (chance(0.1)) m.joints[i].at *= power();
  }
  if (chance(0.5)) m.joints.push_back(distance("string", "spindle", "link3", {1, 0, 0}, {0, -0.5, 0}));
  return m;
}

} // namespace

TEST_CASE("a mass matrix that cannot be factored is refused with the reason") {
  for (const std::string name : {"crash_simulate_lost_mass", "crash_simulate_heavy_and_massless"}) {
    CAPTURE(name);
    try {
      const Run run = simulate(stored_case(name), lasting(0.5));
      check_whole(run); // also well, if it can be done
    } catch (const SceneError& error) {
      CAPTURE(error.what());
      CHECK(error.expected().size() > 30);
    }
  }
}

TEST_CASE("whatever the numbers, a motion is whole, or says why there is none, in time") {
  int refused = 0, runs = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    SimulationOptions options = lasting(0.1);
    options.time_limit = 0.1;
    const auto start = Clock::now();
    try {
      const Run run = simulate(extreme(seed), options);
      ++runs;
      if (!run.time.empty()) check_whole(run);
      CHECK_FALSE(run.message.empty());
    } catch (const SceneError& error) {
      ++refused;
      CHECK(std::string(error.what()).size() > 20);
    }
    CHECK(since(start) < 3); // generous to a busy machine
  }
  CHECK(runs > 20);
  CHECK(refused > 2);
}

TEST_CASE("a motion without end stops at the time limit and keeps what was computed") {
  for (const std::string& name : endless)
    for (const Integrator method :
         {Integrator::automatic, Integrator::bdf, Integrator::adams, Integrator::runge_kutta}) {
      CAPTURE(name, word(method));
      SimulationOptions options = lasting(0.5, method);
      options.time_limit = 0.1;
      const auto start = Clock::now();
      const Run run = simulate(stored_case(name), options);
      CAPTURE(run.message);
      CHECK(since(start) < 5);
      check_whole(run);
      if (run.status == RunStatus::completed) continue;
      CHECK_THAT(run.message, ContainsSubstring("The motion stopped at t = "));
      if (run.status == RunStatus::time_limit)
        CHECK_THAT(run.message, ContainsSubstring("time limit of 0.1 s"));
    }
}

TEST_CASE("a limit that comes before the motion begins leaves a run without samples that says so") {
  SimulationOptions options = lasting(1);
  options.time_limit = 1e-9;
  Simulator simulator(shipped("governor"), options);
  CHECK(simulator.run().time.empty());
  CHECK(simulator.run().status == RunStatus::time_limit);
  CHECK_THAT(simulator.run().message, ContainsSubstring("before the motion began"));
  CHECK_FALSE(simulator.advance(1));
  CHECK_THROWS_AS(simulator.state(), SceneError);
}

TEST_CASE("a motion is cancelled inside its steps") {
  for (const std::string& name : endless) {
    CAPTURE(name);
    std::atomic<bool> cancel = false;
    SimulationOptions options = lasting(1e9);
    options.rate = 0;
    options.cancel = &cancel;
    Simulator simulator(stored_case(name), options);
    Clock::time_point asked;
    std::jthread hand([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      asked = Clock::now();
      cancel = true;
    });
    simulator.advance(1e9, true);
    hand.join();
    CHECK(simulator.run().status != RunStatus::completed);
    if (simulator.run().status == RunStatus::cancelled) CHECK(since(asked) < 1); // 20 ms on a free machine
  }
}

TEST_CASE("a step that was cancelled within is begun anew") {
  const Mechanism m = shipped("governor");
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    SimulationOptions options = lasting(1, method);
    const Run whole = simulate(m, options);
    std::atomic<bool> cancel = false;
    options.cancel = &cancel;
    Simulator simulator(m, options);
    int times = 0;
    {
      std::jthread hand([&](const std::stop_token& stop) {
        while (!stop.stop_requested())
          cancel = true;
      });
      while (times < 30 && !simulator.advance(1, true)) {
        cancel = false;
        ++times;
      }
    }
    cancel = false;
    CHECK(simulator.advance(1, true));
    const Run& run = simulator.run();
    REQUIRE(run.time == whole.time);
    for (std::size_t k = 0; k < run.coordinates.size(); ++k)
      for (std::size_t i = 0; i < run.time.size(); ++i)
        CHECK(std::abs(run.coordinates[k].value[i] - whole.coordinates[k].value[i]) < 1e-6);
  }
}

TEST_CASE("steps too short for the rest ever to be done are refused at once") {
  // A spring without damping at 1e13 1/s.
  Mechanism m;
  m.bodies = {body("block", 1, {0, 0, 0})};
  m.joints = {sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), 1e26, 0.1)};
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const auto start = Clock::now();
    const Run run = simulate(m, lasting(1, method));
    CAPTURE(run.message);
    CHECK(run.status == RunStatus::diverged);
    CHECK_THAT(run.message, ContainsSubstring("steps"));
    CHECK(since(start) < 10);
    check_whole(run);
  }
}
