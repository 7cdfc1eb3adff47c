// Which loads of a periodic motion redundant loops leave open.
#pragma once

#include "engine/periodic/periodic_state.hpp"

namespace flyball {

// Marks reactions, gears and drive torques that are those of the least multipliers, of many that go with the
// same motion. At the beginning of the run and within it: a singular pose at one moment leaves none open.
void mark_open_loads(const Run& run, PeriodicState& out);

} // namespace flyball
