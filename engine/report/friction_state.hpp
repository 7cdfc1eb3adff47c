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

#include "engine/report/analysis.hpp"

namespace flyball {

// What dry friction does in a coordinate that has some.
enum class FrictionPart {
  none,  // nothing, or what its share of the limit says: it rests in balance
  holds, // the coordinate as it is drawn
  slips_forwards,
  slips_backwards,
};
using FrictionParts = std::vector<FrictionPart>; // by find_frictions()

struct StateOnFriction {
  Analysis analysis; // of the mechanism with such joints driven so, at the state
  Solution solution; // in the mechanism's own words, with Solution::frictions
  FrictionParts parts;
  std::vector<bool> implied; // of what slips: the drives give its rate, by coordinate with friction
  // By coordinate with friction, above zero where its part is as it is taken to be: of what slips the rate
  // the way it slips (rad/s or m/s), of what is held the part of the limit that is left. Where loops leave it
  // open how joints share, that of all; infinite of those without a part.
  std::vector<double> margins;
  bool goes = false; // all parts are as they are taken to be, beyond the errors of rates
};

// All parts that friction may have: at first what holds all that it can, as drawn; then those with something
// that slips or rests in balance, most held first, then those with most in balance. Of more than three joints
// that may slip the first, how they begin, and those with which a search by single joints finds a state.
std::vector<FrictionParts> friction_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel);

// The parts that friction has in a state that rests on it.
FrictionParts parts_of(const Mechanism& mechanism, std::span<const FrictionForce> frictions);

// Whether a state with the first parts is one with the others, too: all that has a part there has the same
// one here, and the rest, which there rests in balance, is held here.
bool holds_more(const FrictionParts& here, const FrictionParts& there);

// The steady state with these parts, whether or not it goes with them. Nothing where there is none.
// `slip_search`: how long, as SolveOptions::search, one with something that slips is searched for where
// Newton-Raphson finds none.
std::optional<StateOnFriction> solve_with_parts(const Mechanism& mechanism, const FrictionParts& parts,
                                                const SolveOptions& options, double slip_search = 0);

// Where a solve without this found no steady state. Nothing where there is none, or where of more than three
// joints that may slip the search by single ones finds none. Throws SceneError for starts that name nothing.
std::optional<StateOnFriction> find_friction_state(const Mechanism& mechanism, const SolveOptions& options);

// Of a study that found no steady state without friction: what is said where solving answers with one that
// rests on it (rests_on_friction()); empty where it does not.
std::string asked_of_friction(const Mechanism& mechanism, std::string_view asked,
                              const std::atomic<bool>* cancel);

// Whether friction_parts() are all that there are, as of up to three joints that may slip.
bool tries_all_parts(const Mechanism& mechanism);

// All of them, what is held as drawn first; of `options` the starts do not count. Of what torques drive there
// may be several with the same parts, which a bounded search finds (SolveOptions::search_time for all parts).
std::vector<Solution> find_friction_states(const Mechanism& mechanism, const SolveOptions& options);

// Names, as of coordinate_label(), of coordinates that stand, but may go on at constant rates where friction
// slips: those that have it, and those that loops turn with them.
std::vector<std::string> slipping_coordinates(const Mechanism& mechanism);

} // namespace flyball
