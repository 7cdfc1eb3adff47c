// How a state is told that numbers were moved to.
#pragma once

#include "engine/study/goals.hpp"
#include "engine/study/steady_map.hpp"

namespace flyball {

// What ends a message: which numbers stand at an end of their range, where goals are not reached or something
// was minimised, and that the state is unstable.
std::string closing_words(const GoalAnswer& answer);

// Of a state: numbers, goals, which the map knows in this order, and solution.
void tell_state(SteadyMap& map, const SteadyMap::State& state, std::span<const FreeNumber> free,
                std::span<const Goal> goals, bool details, GoalAnswer& out);

} // namespace flyball
