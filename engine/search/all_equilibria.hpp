// Every equilibrium that a bounded search finds: Newton-Raphson from starts spread over the coordinates'
// ranges, from what is put together of the equilibria known (mixtures, halfway between neighbours, branches
// of the tree exchanged), and deflated so that it cannot find those again (Farrell, Birkisson and Funke,
// Deflation techniques for finding distinct solutions of nonlinear PDEs, 2015). It goes on until what the
// spread starts found, and how often, says that nothing more is to be expected, or its budget is spent. No
// search of this kind can promise completeness.
#pragma once

#include "engine/kkt/configuration_difference.hpp"
#include "engine/search/search_starts.hpp"
#include "engine/solve/newton.hpp"
#include "engine/solve/solution.hpp"
#include "engine/task/progress.hpp"

#include <vector>

namespace flyball {

struct SearchOptions {
  // What to spend at most, in seconds of one core of 2020 or so. It is counted in operations, so that every
  // run on every computer searches alike.
  double seconds = 1;
  int starts = 0;       // at most so many; zero: as many as the budget allows
  double unseen = 0.05; // stop where no more than these are expected to be missing
  std::uint32_t seed = 1;
  ReportProgress progress{}; // the part of the budget that is spent
};

struct SearchReport {
  std::vector<SearchRange> ranges; // by coordinate in System::coordinates
  int starts = 0;                  // Newton-Raphson runs, deflated ones included
  int arrivals = 0;                // runs from the spread starts that led to an equilibrium in the ranges
  // Equilibria expected to be missing: of w found in n arrivals w (w + 1) / (n - w - 2) (Boender and Rinnooy
  // Kan, Bayesian stopping rules for multistart global optimization methods, 1987); infinite where n is too
  // small to tell.
  double unseen = 0;
  SearchEnd end = SearchEnd::settled;
  double fastest = 0;        // the largest speed in the ranges of those that are found; zero: there are none
  bool fastest_turns = true; // rad/s, else m/s
};

struct EquilibriumList {
  // Distinct, their coordinates within the report's ranges: whole turns of a joint without spring or stop
  // count as one, and so do those of a spring that is too soft to be felt. A family along directions that
  // nothing resists is one.
  std::vector<Unknowns> states;
  std::vector<NewtonOutcome> outcomes;
  SearchReport report;
};

// From `drawn` and all over the ranges, for seven tenths of the budget; then speeds that torques give up to a
// thousand times as fast, and where nothing was found either way; the rest goes to the ranges again. The same
// options give the same list, whatever the computer does besides, unless it ends by time.
EquilibriumList find_all_equilibria(const Problem& problem, const Eigen::VectorXd& drawn,
                                    const SearchOptions& options, Workspace& w);

} // namespace flyball
