// Mean and extremes over a period of what a sampled motion recorded.
#pragma once

#include "engine/periodic/periodic_state.hpp"

#include <array>
#include <span>

namespace flyball {

// Of values at even distances over a period, the last one that of the first again. The mean by the
// trapezoidal rule, which a smooth periodic function makes exact; extremes of polynomials of degree six
// through the samples about each local one that could be the furthest. `error` is estimated: what half of the
// samples would have told otherwise.
PeriodicRange range_over_period(std::span<const double> values);

// The same of the size of a vector with these components, by polynomials through these: the size itself has
// a kink where it vanishes.
PeriodicRange size_over_period(const std::array<std::vector<double>, 3>& components);

// Fills coordinates, torques, what joints, bearings, gears and springs bear, and measures, in the run's
// order. Loads are rounded by a part of the largest of all.
void fill_ranges(const Run& run, PeriodicState& out);

// The sizes of what is unique of reactions, by the components that are marked as open in `open`
// (open_loads.hpp); of the same mechanism.
void fill_unique_sizes(const Run& run, const PeriodicState& open, PeriodicState& out);

// Adds to the estimated errors what another approximation of the orbit differs by; null: there is none, and
// errors are not known.
void compare_ranges(const PeriodicState* other, PeriodicState& out);

} // namespace flyball
