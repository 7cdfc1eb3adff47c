// Steady states that rest on dry friction in given ways, searched for all over the ranges: of what torques
// drive there may be several with the same parts, of which Newton-Raphson need not come to those that go.
#pragma once

#include "engine/report/friction_parts.hpp"

namespace flyball {

// Those that a bounded search (SolveOptions::search_time) finds with these parts, where speeds are found or
// something slips, and that go with them.
std::vector<StateOnFriction> find_states_with(const Mechanism& mechanism, const FrictionParts& parts,
                                              const SolveOptions& options);

// Of all that searches find with these parts, and that go with them, one that is not unstable, else the
// first. Short searches come first; the others share five times SolveOptions::search, of which none takes
// more than one.
std::optional<StateOnFriction> search_state(const Mechanism& mechanism, const std::vector<FrictionParts>& all,
                                            const SolveOptions& options);

// Whether one stands and turns as one of these does.
bool is_among(const Solution& state, const std::vector<Solution>& states);

} // namespace flyball
