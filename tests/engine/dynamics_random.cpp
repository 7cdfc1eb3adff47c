// Random mechanisms in motion: energies balance, loops stay closed, and two integrators agree.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"

#include "engine/mechanism/error.hpp"

using namespace flyball;
using namespace flyball::test;
using reference::RandomDrives;
using reference::RandomOptions;

namespace {

RandomOptions options_of(std::uint32_t seed) {
  RandomOptions o;
  o.drives = static_cast<RandomDrives>(seed % 3);
  o.steady = false;
  o.loops = static_cast<int>(seed / 3 % 3);
  o.conservative = seed % 7 == 0;
  o.parallel_axes = seed % 5 == 0;
  o.massless = seed / 2 % 2 == 1;
  o.stops = seed / 4 % 2 == 1;
  o.air = seed % 4 == 1;
  return o;
}

double largest_difference(const Run& a, const Run& b) {
  double worst = 0;
  const std::vector<Pose> x = poses_at(a, a.time.back()), y = poses_at(b, b.time.back());
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(
        {worst, (x[i].position - y[i].position).norm(), x[i].rotation.angularDistance(y[i].rotation)});
  return worst;
}

} // namespace

TEST_CASE("random mechanisms of all kinds: the energies balance and the loops stay closed") {
  int moved = 0, stopped = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    const Mechanism m = reference::random_mechanism(seed, options_of(seed));
    SimulationOptions o = lasting(0.3, Integrator::automatic, 1e-9);
    o.rate = 50;
    o.max_steps = 100000;
    try {
      const Run run = simulate(m, o);
      INFO(run.message);
      check_whole(run);
      CHECK(worst_balance(run) < 1e-5);
      CHECK(run.statistics.position_drift < 1e-12);
      CHECK(run.statistics.velocity_drift < 1e-9);
      ++(run.status == RunStatus::completed ? moved : stopped);
      if (run.status != RunStatus::completed) CHECK_THAT(run.message, ContainsSubstring("stopped at t = "));
    } catch (const SceneError& error) {
      ++refused;
      CHECK_THAT(error.what(), ContainsSubstring("joints."));
    }
  }
  CAPTURE(moved, stopped, refused);
  CHECK(moved > 80);
  CHECK(stopped < 6);
}

TEST_CASE("random mechanisms: integrators agree") {
  int compared = 0;
  const std::uint32_t count = few_or_all(8u, 30u);
  for (std::uint32_t seed = 1000; seed < 1000 + count; ++seed) {
    CAPTURE(seed);
    RandomOptions options = options_of(seed);
    options.stops = false;
    const Mechanism m = reference::random_mechanism(seed, options);
    const auto run = [&](Integrator method) {
      SimulationOptions o = lasting(0.1, method, 1e-10);
      o.rate = 0;
      o.max_steps = 20000;
      return simulate(m, o);
    };
    try {
      const Run a = run(Integrator::runge_kutta), b = run(Integrator::bdf);
      if (a.status != RunStatus::completed || b.status != RunStatus::completed) continue;
      ++compared;
      CHECK(largest_difference(a, b) < 1e-5);
    } catch (const SceneError&) {
    }
  }
  CHECK(compared > static_cast<int>(count / 2));
}
