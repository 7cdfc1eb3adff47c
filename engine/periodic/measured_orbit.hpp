// What a periodic motion measures over its period.
#pragma once

#include "engine/periodic/periodic_state.hpp"
#include "engine/periodic/shooting.hpp"

namespace flyball {

// Records a period of the orbit, finely enough for its ranges, and fills these in, with the errors that the
// periodic motion of coarser steps tells. `how`: it was found; `rate`: of the fastest drive, rad/s. False
// where the motion could not be followed.
bool measure_orbit(Flow& flow, const Orbit& orbit, const ShootingOptions& how, double rate,
                   PeriodicState& out);

} // namespace flyball
