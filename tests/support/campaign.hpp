// Seeded and repeated tests go a short way among the suites, and all the way in the campaign:
// `ctest -C Long`, or FLYBALL_LONG=1 in the environment of any test.
#pragma once

#include <cstdlib>

namespace flyball::test {

inline bool in_campaign() {
  const char* set = std::getenv("FLYBALL_LONG");
  return set && *set == '1';
}

// How many seeds, steps or places: `few` of them, or `all` in the campaign.
template <class Number>
Number few_or_all(Number few, Number all) {
  return in_campaign() ? all : few;
}

} // namespace flyball::test
