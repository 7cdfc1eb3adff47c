// All steady states that rest on dry friction in the same way: of what torques drive there may be several.
#pragma once

#include "engine/report/friction_state.hpp"

namespace flyball {

// Those that a bounded search (SolveOptions::search_time) finds with these parts, where speeds are found, and
// that go with them.
std::vector<StateOnFriction> find_states_with(const Mechanism& mechanism, const FrictionParts& parts,
                                              const SolveOptions& options);

// Whether one stands and turns as one of these does.
bool is_among(const Solution& state, const std::vector<Solution>& states);

} // namespace flyball
