// Of what slips in loops: which rates the drives give.
#pragma once

#include "engine/report/friction_state.hpp"

namespace flyball {

// By find_frictions(): whether the drives give the rate of what slips, as of a clutch between two shafts that
// torques drive. All ways of those that close loops, none at first; of more than six that close loops the
// torques give the rates of all but the first six.
std::vector<std::vector<bool>> implied_ways(const Mechanism& mechanism,
                                            const std::vector<CoordinateReference>& frictions,
                                            const FrictionParts& parts);

// Whether the two bodies of a joint hang together without it.
bool closes_a_loop(const Mechanism& mechanism, int joint);

} // namespace flyball
