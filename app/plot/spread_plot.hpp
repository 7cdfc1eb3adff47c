// How samples are distributed, as a plot and as a table.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/spread.hpp"

namespace flyball {

// A histogram of one output: of the samples that followed, beside it those in another steady state, and what
// a normal distribution with the rates' deviation would make of the former. In SI units.
Plot histogram_plot(const SpreadAnswer& answer, std::size_t output);

// A line of a table: the numbers of sample i, its fate, and the outputs, in SI units.
std::string spread_row(const SpreadAnswer& answer, std::span<const Tolerance> tolerances, std::uint64_t seed,
                       std::size_t i, SampleFate fate, std::span<const double> values);
// The whole table, with what its columns are.
std::string spread_csv(const SpreadAnswer& answer, std::span<const Tolerance> tolerances, std::uint64_t seed);

} // namespace flyball
