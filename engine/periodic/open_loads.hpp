// Which loads of a periodic motion redundant loops leave open.
#pragma once

#include "engine/periodic/periodic_state.hpp"

namespace flyball {

// Marks components of reactions, gears and drive torques that are those of the least multipliers, of many
// that go with the same motion: which are open at two of three moments of the run. A singular pose at one
// moment leaves none open, and a component that happens to lie across the open direction at one is not
// unique.
void mark_open_loads(const Run& run, PeriodicState& out);

} // namespace flyball
