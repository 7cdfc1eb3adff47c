// Runs cases on a few threads, each on its own: an exception is that case's failure, a hang is ended, and a
// crash is told with the names of the cases that ran.
#pragma once

#include "tests/stress/case.hpp"

namespace flyball::stress {

// s a case; sanitizers slow everything down.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double patience = 300;
#else
inline constexpr double patience = 20;
#endif

struct Result {
  std::string family, name;
  Verdict verdict;
  double wall_s = 0; // with the reference
};

// In the order of the cases; with `other_starts` remarks on refusals tell of those, too.
std::vector<Result> run_cases(const Cases& cases, int threads, bool other_starts);

} // namespace flyball::stress
