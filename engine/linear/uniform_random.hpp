// Numbers of no particular value, the same on every computer: what a generator gives is laid down by the
// standard, what its distributions make of that is not.
#pragma once

#include <algorithm>
#include <random>

namespace flyball {

// Evenly spread from `from` to less than `to`, by 53 bits.
inline double uniform(std::mt19937& random, double from, double to) {
  constexpr double range = 4294967296.; // of one number
  const double low = static_cast<double>(random()), high = static_cast<double>(random());
  const double part = std::min((low + high * range) / (range * range), 1 - 0x1p-53);
  return part * (to - from) + from;
}

} // namespace flyball
