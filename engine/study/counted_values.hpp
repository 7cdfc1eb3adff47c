// What is told along the branches of a diagram that hang together. A hinge's angle, or a measure in rad, that
// is told between -pi and pi goes on beyond: whole turns are counted from a state on the first branch.
#pragma once

#include "engine/continuation/branches.hpp"

#include <string>
#include <vector>

namespace flyball {

struct CountedValues {
  std::vector<std::vector<double>> branches; // at each point; empty of one that does not hang together
  std::vector<double> special;               // at each special point; of such a branch not a number
  bool goes_round = false; // one comes back to where it began turned by a whole turn or more
};

// Of a number that is found, or a measure, whose value in `state` is given.
CountedValues counted_values(const Mechanism& mechanism, const ResponseDiagram& diagram,
                             const ResponsePoint& state, const std::string& name, double value);

// A number that is found, or a measure, at a point of a branch; no number where it has none of this name.
double told_value(const ResponsePoint& point, const std::string& name);

// An angle by the whole turns that bring it nearest to another.
double counted_on(double angle, double from);

} // namespace flyball
