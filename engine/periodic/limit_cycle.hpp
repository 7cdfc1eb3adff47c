// The limit cycle beside a steady state that hunts: where swings about it grow, the motion that they come to.
#pragma once

#include "engine/periodic/periodic_state.hpp"

namespace flyball {

// Whether what grows fastest about an unstable steady state swings: by its eigenvalues, or multipliers.
bool hunts(const Solution& solution);

// find_periodic_state() with more patience: nothing else is asked for. A search that comes back to the steady
// state has found none.
PeriodicState find_limit_cycle(const Mechanism& mechanism, const std::atomic<bool>* cancel = nullptr,
                               const ReportProgress& progress = {});

} // namespace flyball
