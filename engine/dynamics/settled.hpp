// When a damped motion has come to rest where the direct solution says.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

struct Settled {
  // s, since the start of the run: the first sample from which on every one is within `within` of the steady
  // state.
  std::optional<double> time;
  double distance = 0; // of the last sample
  double within = 0;
  std::string message; // a sentence
};

// How far a sample is from a steady state: the largest difference of a free coordinate, in radians or
// relative to the mechanism's reach. Whole turns of joints without spring or stop do not count, nor do
// directions that nothing resists. Infinite where the two do not fit.
double distance_from(const Run& run, std::size_t sample, const Solution& steady);

// Whether a damped run that has not settled in a steady state runs into another one: it has come near it, and
// is nearer than to `steady` by far.
bool runs_into(const Run& run, const Solution& steady, const Solution& other);

Settled find_settled(const Run& run, const Solution& steady, double within = 1e-6);

} // namespace flyball
