// From a start to the steady state that is the answer. Where Newton-Raphson and what catches it lead to none,
// or to an equilibrium that holds at one phase of the drives only, other equilibria are looked for before
// solving refuses. Where torques drive there is no potential to go down by: a state that is unstable is left
// for the stable one that the slow motion from the start leads to, or else the nearest of a search.
#pragma once

#include "engine/search/all_equilibria.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/existence.hpp"
#include "engine/solve/factored_state.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/stability.hpp"

#include <cstddef>
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
  double fastest = 0; // up to which speed it looked, where speeds are found (SearchReport)
  bool fastest_turns = true;
};

struct SteadyStateOptions {
  bool nearest = false;     // the plain Newton-Raphson answer, stable or not, and no other
  bool warm = false;        // the start is a neighbour's answer
  bool newton_only = false; // see find_equilibrium()
  double seconds = 0;       // of the search for another (SearchOptions); zero: none
  ReportProgress progress{};
};

// A steady state with what was computed at it. Solving again uses its storage again: nothing is allocated for
// a system of the same size.
class SteadyState {
 public:
  Found found;
  Existence existence;
  bool holds = false;                // found, and at every phase
  std::optional<OtherStates> others; // looked for where it did not hold
  std::vector<double> phases;        // s, at which it was looked at; none where nothing turns
  std::vector<double> history;
  Eigen::VectorXd start; // where the run that found it began
  ErrorEstimate error;   // `solution` with what other phases ask the state to move
  // Of an answer that holds, in the matrices, where torques drive few coordinates: what find() went by.
  std::optional<Stability> stability;

  // find_equilibrium() from `start`, or where a neighbour's answer leads elsewhere from `drawn`; its last
  // digits and their error; whether it holds at every phase; and where it does not, or nothing was found,
  // whether another does that a bounded search finds: the stable one nearest to the start. `drawn` is where
  // distances are measured from. Where torques drive an unstable one is left for a stable one. A coordinate
  // that nothing depends on stays where the run began.
  void find(const Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& drawn,
            const SteadyStateOptions& options);

  // The same for an equilibrium that was found already, `found`: its last digits, their error, and whether it
  // holds at every phase.
  void complete(const Problem& problem);

  // The balance at this state, of the problem that it was found for or one of another form: factored when
  // first asked for in that form, and kept.
  FactoredState factored(const Problem& problem);

  // Storage for states beside this one; and that of this one, whose factors are then given up.
  Workspace& elsewhere() { return balance_.elsewhere(); }
  Workspace& reuse() {
    factored_.reset();
    refined_with_.reset();
    return balance_;
  }

 private:
  // An answer with what was computed of it.
  struct Answer {
    Found found;
    std::vector<double> phases;
    Existence existence;
    ErrorEstimate error;
    std::optional<Stability> stability;
    bool holds = false, unstable = false;
    std::size_t recorded = 0; // entries of `history`
  };
  // Puts `candidate` in the place of this state, complete; returns what it takes the place of.
  Answer replace(const Problem& problem, Found candidate);
  void put_back(Answer answer);

  void refuse(const Problem& problem, const Eigen::VectorXd& from, Existence why);
  void keep_where_started(const Problem& problem);
  void refine_found(const Problem& problem);
  void check_phases(const Problem& problem);
  void find_once(const Problem& problem, const Eigen::VectorXd& from, const Eigen::VectorXd& drawn,
                 const SteadyStateOptions& options);
  void judge(const Problem& problem);
  void leave_far(const Problem& problem, const Eigen::VectorXd& drawn, const SteadyStateOptions& options);
  void search_nearer(const Problem& problem, const Eigen::VectorXd& drawn, const SteadyStateOptions& options);
  bool is_nearer(const Problem& problem, const Unknowns& z) const;
  void leave_unstable(const Problem& problem, const Eigen::VectorXd& drawn,
                      const SteadyStateOptions& options);
  bool take_if_stable(const Problem& problem, const Eigen::VectorXd& drawn, Found candidate);
  void search_another(const Problem& problem, const Eigen::VectorXd& drawn, double seconds);

  std::vector<int> still_; // entries of q that keep_where_started() put back
  Workspace balance_;
  std::optional<KktForm> factored_;     // the form that is, at this state
  std::optional<KktForm> refined_with_; // the form whose factors refine() left, beside it
  bool unstable_ = false;               // says judge()
  double shift_ = 0;                    // 1/s^2: of the metric that keeps its neutral directions still
};

} // namespace flyball
