// Long motions of which only the end is looked at.
#pragma once

#include "engine/dynamics/simulator.hpp"

#include <utility>

namespace flyball::test {

// The motion that `options` ask for, followed for `quiet` (s) without samples, each of which ends a step, and
// then for the rest of its duration with them. `quiet` is counted from its start.
inline Run sampled_later(const Mechanism& mechanism, SimulationOptions options, double quiet) {
  const double rate = std::exchange(options.rate, 0), duration = std::exchange(options.duration, quiet);
  const Run before = simulate(mechanism, options);
  if (before.status != RunStatus::completed) return before;
  options.start = Start::state;
  options.state = state_at(before, before.time.size() - 1);
  options.at.clear();
  options.kick.clear();
  options.rate = rate;
  options.duration = duration - quiet;
  return simulate(mechanism, options);
}

} // namespace flyball::test
