// From a start to the steady state that is the answer. Where Newton-Raphson and what catches it lead to none,
// or to an equilibrium that holds at one phase of the drives only, other equilibria are looked for before
// solving refuses.
#pragma once

#include "engine/search/all_equilibria.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/existence.hpp"

#include <optional>

namespace flyball {

// Coordinates; with more of them a refusal would take longer than a second or two.
constexpr int largest_for_answer_search = 120;

// The search for another steady state where the one found does not hold at every phase, or none was found.
struct OtherStates {
  bool searched = false; // else there are too many coordinates, or no time was given
  int starts = 0;        // Newton-Raphson runs
  int equilibria = 0;    // found at the drawn phase
  int steady = 0;        // of these, at every phase
  SearchEnd end = SearchEnd::settled;
};

struct SteadyStateOptions {
  bool nearest = false; // the plain Newton-Raphson answer, stable or not, and no other
  bool warm = false;    // the start is a neighbour's answer
  double seconds = 0;   // of the search for another (SearchOptions); zero: none
  ReportProgress progress{};
};

struct SteadyState {
  Found found;
  Existence existence;
  bool holds = false;                // found, and at every phase
  std::optional<OtherStates> others; // looked for where it did not hold
  std::vector<double> phases;        // s, at which it was looked at; none where nothing turns
  std::vector<double> history;
  Eigen::VectorXd start; // where the run that found it began
  Eigen::VectorXd error; // (nv), rad or m: of refine(), and what other phases ask it to move
};

// The steady state that solving answers with: find_equilibrium() from `start`, or where a neighbour's answer
// leads elsewhere from `drawn`; its last digits and their error; whether it holds at every phase; and where
// it does not, or nothing was found, whether another does that a bounded search finds: the stable one
// nearest to the start. `out` is used again: nothing is allocated in it for a system of the same size.
void find_steady_state(const Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& drawn,
                       const SteadyStateOptions& options, Workspace& w, SteadyState& out);

// Whether a refined state holds at every phase. Adds to its error what it leaves there.
Existence check_refined(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                        Workspace& w, Eigen::VectorXd& error);

} // namespace flyball
