// The last net: where Newton-Raphson and what catches it lead to no steady state, or to an equilibrium that
// holds at one phase of the drives only, other equilibria are looked for before solving refuses.
#pragma once

#include "engine/equilibrium/all_equilibria.hpp"
#include "engine/equilibrium/existence.hpp"
#include "engine/equilibrium/find_equilibrium.hpp"

#include <optional>

namespace flyball {

// Coordinates; with more of them a refusal would take longer than a second or two.
constexpr int largest_for_answer_search = 120;

struct AnswerSearch {
  std::optional<Found> answer; // holds at every phase
  Existence existence;         // of the answer
  int equilibria = 0;          // found at the drawn phase
  int steady = 0;              // of these, at every phase
  SearchReport report;
};

// Of the equilibria that a bounded search of `seconds` (see SearchOptions) finds, the one that holds at all
// `phases`, is stable if any is, and lies nearest to `start`. An answer is left evaluated and factored in the
// workspace. `problem` must be dense.
AnswerSearch search_answer(const Problem& problem, const Eigen::VectorXd& start,
                           const std::vector<double>& phases, double seconds, Workspace& w);

// The steady state that solving answers with, where only the state itself is wanted: find_equilibrium() from
// `start` and, where that leads to none that holds at every phase, search_answer() for `seconds`. `out` is
// used again: nothing is allocated in it for a system of the same size.
struct SteadyState {
  Found found;
  Existence existence;
  bool holds = false;         // found, and at every phase
  std::string tried;          // where it does not: what the search did, in a sentence
  std::vector<double> phases; // s, at which it was looked at; none where nothing turns
  std::vector<double> history;
  Eigen::VectorXd error; // of refine()
};
void find_steady_state(const Problem& problem, const Eigen::VectorXd& start, double seconds, Workspace& w,
                       SteadyState& out);

// What was tried, as a sentence to follow a refusal: "None of 3 equilibria found by 120 starts holds ...".
std::string describe(const AnswerSearch& search);

} // namespace flyball
