// What the suite found: a line a case, and the table by family that README.md shows.
#pragma once

#include "tests/stress/runner.hpp"

namespace flyball::stress {

struct Summary {
  int cases = 0, solved = 0, refused = 0, unclear = 0, failed = 0;
  int judged = 0, bounded = 0; // coordinates
  double true_error = 0;       // the largest; rad or m, of the coordinates that Verdict tells
  double worst = 0;            // true error / estimate
  double caution = 0;          // median of Verdict::caution
  double cautious = 0;         // share of those over 100
  double slowest = 0;          // s, of a solve
  double share() const { return judged == 0 ? 1 : static_cast<double>(bounded) / judged; }
};

Summary summarize(const std::vector<Result>& results, const std::string& family = ""); // "": all

std::string csv(const std::vector<Result>& results);
std::string markdown(const std::vector<Result>& results);
std::string failures(const std::vector<Result>& results); // a line each, "" where there are none

// Nothing failed, at least 99 % of the estimates bound the error, and none is exceeded by more than 100x.
bool good(const Summary& summary);

} // namespace flyball::stress
