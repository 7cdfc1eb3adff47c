// Mean and extremes over a period of what a sampled motion recorded.
#pragma once

#include "engine/periodic/periodic_state.hpp"

#include <span>

namespace flyball {

// Of values at even distances over a period, the last one that of the first again. The mean by the
// trapezoidal rule, which a smooth periodic function makes exact; extremes of polynomials of degree six
// through the samples about each local one that could be the furthest. `error` is estimated: what half of the
// samples would have told otherwise.
PeriodicRange range_over_period(std::span<const double> values);

// Fills coordinates, torques and measures, in the run's order.
void fill_ranges(const Run& run, PeriodicState& out);

// Adds to the estimated errors what another approximation of the orbit differs by; null: there is none, and
// errors are not known.
void compare_ranges(const PeriodicState* other, PeriodicState& out);

} // namespace flyball
