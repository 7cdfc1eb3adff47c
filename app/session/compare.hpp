// Error against run time: the direct solution and the motion, measured on the scene as it is. Nothing is
// measured before a person asks.
#pragma once

#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/study/compare.hpp"

#include <string>

namespace flyball {

struct Session;

struct CompareRequest {
  SharedMechanism mechanism;
  int repeats = 0;
  double time_limit = 0; // s, by the clock
};

struct CompareState {
  Study<CompareRequest, Comparison> measured;
  int repeats = 5;
  double time_limit = 60; // s, after which it keeps what it has
  std::string shown;      // measure whose errors are shown; empty: the coordinates
};

void begin_comparison(Session& session);
// Takes what was measured; of one that was stopped only what there was nothing better than before. Stops
// where the mechanism changes before its solution was found. Either way `measured.problem` says why.
void update_comparison(Session& session);
bool comparing(const Session& session);
// Whether the result is of the mechanism as it is now.
bool comparison_is_current(const Session& session);

} // namespace flyball
