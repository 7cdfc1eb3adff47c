// Error against run time as a plot: a mark for each iteration of the direct solution and for each run of the
// motion, those joined that no other of the integrator beats in both; and the same as a table.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/compare.hpp"

namespace flyball {

// Of the coordinates, or of one of Comparison::measures.
Plot comparison_plot(const std::string& title, const Comparison& comparison,
                     std::optional<std::size_t> measure = {});

// Everything that was measured, a line a mark: times in s, errors in radians or relative to the reach, those
// of measures in their units.
std::string comparison_csv(const Comparison& comparison);

} // namespace flyball
