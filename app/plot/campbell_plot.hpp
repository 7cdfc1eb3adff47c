// A branch's Campbell diagram as a plot in SI units: frequencies of the modes over the drive's speed or a
// number that sets it, lines of excitation, critical speeds.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/campbell.hpp"

#include <span>
#include <string>

namespace flyball {

// In Hz or rad/s. `names` are those of the branch's lines, empty for those that are left out; `values` the
// axis' ends; `orders` the lines of so many oscillations a turn.
Plot campbell_plot(const Mechanism& mechanism, const std::string& address, const CampbellDiagram& diagram,
                   std::size_t branch, std::span<const std::string> names, PlotRange values,
                   std::span<const double> orders, bool hertz);

// "2×"
std::string order_text(double order);

} // namespace flyball
