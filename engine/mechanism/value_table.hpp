// A table in an expression: "table(rate(spin), [0, 10 N m], [5, 8 N m], [9, 0 N m])".
#pragma once

#include "engine/mechanism/dual.hpp"

#include <vector>

namespace flyball {

// Through its points goes a piecewise cubic curve with a continuous slope that rises and falls only where
// they do (Fritsch and Butland, A method for constructing local monotone piecewise cubic interpolants, 1984,
// with the weights and the ends of Moler, Numerical Computing with MATLAB, section 3.6). Beyond the ends it
// goes on straight, with their slopes.
class ValueTable {
 public:
  struct Point {
    double x = 0, y = 0; // SI units
  };
  // Two points or more, x strictly ascending.
  explicit ValueTable(std::vector<Point> points);
  Dual operator()(Dual x) const;

 private:
  std::vector<Point> points_;
  std::vector<double> slopes_;
};

} // namespace flyball
