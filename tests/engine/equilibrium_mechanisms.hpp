// Ways to solve and to judge solutions, for the tests of solving.
#pragma once

#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace flyball::test {

// Failures are told with all digits: they are about the last ones.
inline const bool all_digits = [] {
  Catch::StringMaker<double>::precision = 17;
  return true;
}();

inline Solution solve(const Mechanism& m, const SolveOptions& options = {}) {
  validate(m);
  return Analysis(m).solve(options);
}

inline SolveOptions nearest() {
  SolveOptions o;
  o.nearest = true;
  return o;
}

inline SolveOptions from(const std::string& joint, double value) {
  SolveOptions o;
  o.start = {{joint, value}};
  return o;
}

// The root of an increasing or decreasing f between `a` and `b`, by bisection to the last digit.
template <class F>
long double root(F f, long double a, long double b) {
  const bool rising = f(b) > 0;
  REQUIRE((f(a) > 0) != rising);
  for (int i = 0; i < 200; ++i) {
    const long double middle = (a + b) / 2;
    ((f(middle) > 0) == rising ? b : a) = middle;
  }
  return (a + b) / 2;
}

// Within what the solution claims, and within `tolerance` of what is wanted.
inline void check_value(const Solution& s, const std::string& joint, long double wanted,
                        double tolerance = 1e-12, int index = 0) {
  const CoordinateSolution& c = coordinate(s, joint, index);
  const auto away = static_cast<double>(std::abs(c.value - wanted));
  const auto rounding = static_cast<double>(std::abs(wanted)) * 1e-16;
  CAPTURE(joint, index, c.value, static_cast<double>(wanted), c.error, s.message);
  CHECK(away <= tolerance);
  CHECK(away <= c.error + rounding);
}

inline bool stable(const Solution& s) {
  return s.stable == true;
}

} // namespace flyball::test
