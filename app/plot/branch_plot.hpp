// A diagram of branches as a plot of one coordinate over the parameter.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/continuation/branches.hpp"

namespace flyball {

// Stable parts solid, others dashed; special points are marked. `coordinate` is an index into the points'
// coordinates, of which the diagram has at least one.
Plot branch_plot(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 std::size_t coordinate);

} // namespace flyball
