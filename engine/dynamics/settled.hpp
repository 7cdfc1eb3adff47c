// When a damped motion has come to rest where the direct solution says.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

// The coordinate of a sample that is farthest from the steady state; a rotation as a whole.
struct FarCoordinate {
  std::string joint;
  int index = 0, count = 1;
  bool angle = false;
  bool speed = false; // it is the speed that differs
  double away = 0;    // rad or m; of a speed a second
};

struct Settled {
  // s, since the start of the run: the first sample from which on every one is within `within` of the steady
  // state.
  std::optional<double> time;
  bool held = false;   // it has come to rest where friction holds it, and not there
  double distance = 0; // of the last sample
  double within = 0;
  std::optional<FarCoordinate> farthest; // of the last sample; nothing where none differs
  std::string message;                   // a sentence
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
