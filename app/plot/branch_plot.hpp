// A diagram of branches as a plot of one coordinate or measure over the parameter.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/continuation/branches.hpp"

namespace flyball {

// One of a point's coordinates, or of its measures.
struct PlottedQuantity {
  std::size_t index = 0;
  bool measure = false;
  bool speed = false; // of the coordinate: how fast it goes on, not where it stands
};

// Stable parts solid, others dashed; special points are marked. The diagram has at least one point, and every
// point the quantity; where it is undefined there is a gap.
Plot branch_plot(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 const PlottedQuantity& shown);

// Whether this coordinate stands in some states and slips on friction in others: then its speed shows both.
bool slips_somewhere(const ResponseDiagram& diagram, std::size_t coordinate);

// What is found of a coordinate by its name (found_number()), else a measure of the mechanism; nothing where
// there is none.
std::optional<PlottedQuantity> find_plotted(const Mechanism& mechanism,
                                            const std::vector<CoordinateSolution>& coordinates,
                                            const std::string& name);
// The same of the first point of a diagram; also the place or the speed of what only in others stands or
// slips.
std::optional<PlottedQuantity> find_plotted(const Mechanism& mechanism, const ResponseDiagram& diagram,
                                            const std::string& name);
// What can be plotted, as find_plotted takes it: "slide, height".
std::string plotted_names(const Mechanism& mechanism, const std::vector<CoordinateSolution>& coordinates);
// As that takes it.
std::string plotted_name(const ResponsePoint& point, const PlottedQuantity& quantity);
// Not a number where a measure is undefined, or what stands is asked of a coordinate that goes on. The speed
// of what stands is zero.
double plotted_value(const ResponsePoint& point, const PlottedQuantity& quantity);

} // namespace flyball
