// Solves a mechanism and holds the answer to the reference.
#pragma once

#include "tests/stress/case.hpp"

#include <optional>

namespace flyball::stress {

struct Expectation {
  bool must = false; // a refusal is a failure
  // Only half of the digits exist here, and the answer has to say so: marginal, with an estimate to match.
  bool half_digits = false;
  // rad or m by coordinate: where the fold is, for a state that rounding has taken off its end.
  std::vector<std::pair<std::string, double>> known{};
};

Verdict judge(const Mechanism& mechanism, const SolveOptions& options, const Expectation& expected,
              const std::atomic<bool>& cancel);

// A case of one mechanism.
Case solve_case(std::string family, std::string name, Mechanism mechanism, Expectation expected = {},
                SolveOptions options = {});

// Whether every number that a person could see is finite.
bool all_finite(const Solution& solution);

} // namespace flyball::stress
