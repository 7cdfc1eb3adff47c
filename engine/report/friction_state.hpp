// Steady states that there are by dry friction. Without it the balance holds nowhere, or other than it does
// where what torques turn has friction, as a brake on a shaft; but friction holds joints as they are drawn,
// or they slip at constant rates, and friction gives its limit against them:
//
//   - a joint that it holds stands still, as if driven at the speed zero, and what that takes is within the
//     limit at every phase of the drives;
//   - one that slips has its limit for a torque, and its rate is found as that of a drive by torque; it
//     opposes that torque. Where it closes a loop in which nothing else goes on, as of a clutch whose other
//     side rests against a stop, the drives give its rate;
//   - beside such joints others rest in balance, with nothing asked of their friction.
#pragma once

#include "engine/report/friction_parts.hpp"

namespace flyball {

// Where a solve without this found no steady state. Nothing where there is none, or where of more than three
// joints that may slip the search by single ones finds none. Throws SceneError for starts that name nothing.
std::optional<StateOnFriction> find_friction_state(const Mechanism& mechanism, const SolveOptions& options);

// Of a study that found no steady state without friction: what is said where solving answers with one that
// rests on it (rests_on_friction()); empty where it does not.
std::string asked_of_friction(const Mechanism& mechanism, std::string_view asked,
                              const std::atomic<bool>* cancel);

// All of them, what is held as drawn first; of `options` the starts do not count. Of what torques drive there
// may be several with the same parts, which a bounded search finds (SolveOptions::search_time for all parts).
std::vector<Solution> find_friction_states(const Mechanism& mechanism, const SolveOptions& options);

} // namespace flyball
