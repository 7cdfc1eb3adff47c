// Numbers to try: decades, seeds, starts anywhere, and short words for them.
#pragma once

#include "engine/report/analysis.hpp"
#include "tests/support/dice.hpp"

#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace flyball::stress {

using test::Dice;

inline std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", x);
  return text;
}

// 10^from ... 10^to by `step` decades; the short form takes every third.
inline std::vector<double> decades(int from, int to, int step, bool thinned) {
  std::vector<double> out;
  for (int e = from; e <= to; e += thinned ? 3 * step : step)
    out.push_back(std::pow(10., e));
  return out;
}

// Seeds 0 ... count - 1, and beyond them those at which something once went wrong.
inline std::vector<int> seeds(int count, std::initializer_list<int> kept) {
  std::vector<int> out;
  for (int seed = 0; seed < count; ++seed)
    out.push_back(seed);
  for (const int seed : kept)
    if (seed >= count) out.push_back(seed);
  return out;
}

// Free coordinates anywhere: angles in a whole turn, lengths within twice the size of the mechanism.
inline std::vector<std::pair<std::string, double>> random_start(const Analysis& analysis, const Mechanism& m,
                                                                Dice& dice) {
  double reach = 0;
  for (const Body& b : m.bodies)
    for (const Body& other : m.bodies)
      reach = std::max(reach, (b.position - other.position).norm());
  if (reach == 0) reach = 1;
  std::vector<std::pair<std::string, double>> start;
  for (const CoordinateSolution& c : analysis.summary().coordinates) {
    if (c.driven || c.dependent) continue;
    const double at =
        c.angle ? dice.between(-std::numbers::pi, std::numbers::pi) : c.value + dice.between(-2, 2) * reach;
    start.emplace_back(c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index), at);
  }
  return start;
}

} // namespace flyball::stress
