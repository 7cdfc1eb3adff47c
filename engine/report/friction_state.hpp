// Steady states that there are by dry friction alone. Without it the balance holds nowhere, but friction
// holds joints as they are drawn; or they slip at constant rates, and friction gives its limit against them:
//
//   - a joint that it holds stands still, as if driven at the speed zero, and what that takes is within the
//     limit at every phase of the drives;
//   - one that slips has its limit for a torque, and its rate is found as that of a drive by torque; it
//   opposes
//     that torque.
#pragma once

#include "engine/report/analysis.hpp"

#include <optional>

namespace flyball {

struct FrictionState {
  Analysis analysis; // of the mechanism with such joints driven so, at the state
  Solution solution; // in the mechanism's own words, with Solution::frictions
};

// Where a solve without this found no steady state. Nothing where there is none, or where more than three
// joints would have to be tried for slipping. Throws SceneError for starts that name nothing.
std::optional<FrictionState> find_friction_state(const Mechanism& mechanism, const SolveOptions& options);

} // namespace flyball
