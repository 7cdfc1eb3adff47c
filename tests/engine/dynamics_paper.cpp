// The paper's two mechanisms in motion: where the damped motion ends, and that the undamped one goes on.
#include "tests/engine/dynamics_runs.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("the damped motion ends where the direct solution says") {
  for (const auto& [name, duration] : {std::pair{"pendulum", 4.}, std::pair{"governor", 40.}})
    for (const Integrator method : all_integrators) {
      CAPTURE(name, word(method));
      const Mechanism m = shipped(name);
      const Run run = simulate(m, lasting(duration, method));
      check_sound(run);
      CHECK(run.method == method);
      const Solution steady = solve(m);
      CHECK(distance_from(run, run.time.size() - 1, steady) < 1e-8);
      CHECK(distance_from(run, 0, steady) > 0.1);
      const Settled settled = find_settled(run, steady, 1e-6);
      REQUIRE(settled.time.has_value());
      CHECK(*settled.time > 0.1);
      CHECK(*settled.time < duration);
      CHECK_THAT(settled.message, ContainsSubstring("Settled after"));
    }
}

TEST_CASE("the undamped motion goes on, and its Jacobi integral stays") {
  for (const auto& [name, joint, swing] :
       {std::tuple{"pendulum", "theta", 0.3}, std::tuple{"governor", "slide", 0.05}})
    for (const Integrator method : {Integrator::automatic, Integrator::bdf, Integrator::adams}) {
      CAPTURE(name, word(method));
      // The slow ones only so far.
      const double duration = method == Integrator::automatic ? 100 : 5;
      const Run run = simulate(shipped(name), undamped(lasting(duration, method)));
      check_sound(run, 1e-5);
      CHECK(run.time.back() == duration);
      CHECK_FALSE(run.damped);
      CHECK(run.energy.dissipated.back() == 0);
      const double drift = jacobi_drift(run);
      CAPTURE(drift);
      CHECK(drift < (method == Integrator::automatic ? 1e-7 : 1e-5));
      // The last second swings as far as the first did.
      const std::vector<double>& x = track(run, joint).value;
      const auto [low, high] = std::ranges::minmax(std::span(x).last(150));
      CHECK(high - low > swing);
    }
}
