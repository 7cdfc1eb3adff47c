// Error against run time as a plot: a mark for each iteration of the direct solution, a curve for each
// integrator and simulated duration over its tolerances.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/compare.hpp"

namespace flyball {

Plot comparison_plot(const std::string& title, const Comparison& comparison);

} // namespace flyball
