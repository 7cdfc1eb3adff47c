// The rates of the coordinates with a pinned number, as they are shown below its slider.
#pragma once

#include "app/session/units.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace flyball {

// One coordinate's rate with the number.
struct ShownRate {
  std::string name; // of the coordinate
  double value = 0; // in `unit`
  std::string unit; // "mm/(rad/s)"
  double share = 0; // of the mechanism's reach or of a radian: to tell which moves most
};

// Kept while neither the answer nor the slider nor the units on the screen change.
struct KeptRates {
  std::uint64_t ticket = 0;           // of the answer; 0: nothing is kept
  double value = 0, from = 0, to = 0; // of the slider
  DisplayUnits units;
  std::vector<ShownRate> rates;
};
using ShownRates = std::map<std::string, KeptRates>; // by the slider's address

} // namespace flyball
