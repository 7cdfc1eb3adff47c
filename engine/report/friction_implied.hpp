// Of what slips in loops: which rates the drives give, and what is steady with them.
#pragma once

#include "engine/report/friction_parts.hpp"

namespace flyball {

// By find_frictions(): whether the drives give the rate of what slips, as of a clutch between two shafts that
// torques drive. All ways of those that close loops, none at first; of more than six that close loops the
// torques give the rates of all but the first six.
std::vector<std::vector<bool>> implied_ways(const Mechanism& mechanism,
                                            const std::vector<CoordinateReference>& frictions,
                                            const FrictionParts& parts);

// With rates that are found by the torques or, where that leads to no state, of some that the drives give: at
// first by Newton-Raphson alone, as one of the two has none. Of these ways one that goes before others.
// `loose`: see attempt_parts(). `attempts`: counts those made, if given.
std::optional<StateOnFriction> let_slip(const Mechanism& mechanism,
                                        const std::vector<CoordinateReference>& frictions,
                                        const FrictionParts& parts, const SolveOptions& options,
                                        bool loose = false, int* attempts = nullptr);

// Whether the two bodies of a joint hang together without it.
bool closes_a_loop(const Mechanism& mechanism, int joint);

} // namespace flyball
