// What the solvers found, in sentences for a person. The solvers below say what happened in values; the words
// are made here.
#pragma once

#include "engine/report/report.hpp"
#include "engine/search/steady_state.hpp"

namespace flyball {

// Choices in compiling worth knowing: where a loop was cut for the drives.
std::vector<std::string> notes(const System& system, const Mechanism& mechanism);

// What happened on the way to one equilibrium, or why there is none; empty for a plain run that arrived.
std::string message(const Found& found, const Problem& problem);

// What was done to find another steady state after the first run had ended in `first`: to follow a refusal.
std::string message(const OtherStates& others, Status first);

// What a search for all equilibria found and left.
std::string message(const AllSolutions& all);

struct FailureMessage {
  std::string text;
  bool change_point =
      false; // it is that a loop that turns with the drives is drawn at one, and what would help
};

// Why there is no answer, naming the part that is to blame. Throws Interrupted.
FailureMessage failure_message(const ReportInput& input, Workspace& w);

// Of a converged solution whose other parts are filled; `rank`: of the constraint equations.
std::string solution_message(const ReportInput& input, int rank, const Solution& solution);

// Of a state that rests on dry friction, for what is not asked of such states: `asked` begins the sentence on
// it, as "Rates of change are known".
std::string rests_on_friction(const Solution& solution, std::string_view asked);

// Looks for what runs away (find_unbounded) where `out` has no answer or an unstable one; names it in
// `out.unheld`, and in `out.message` what holds nothing and what would mend it: of an unstable answer beside
// what the message says already. Leaves `out` alone where nothing runs away.
void explain_unbounded(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& start,
                       Workspace& w, Solution& out);

} // namespace flyball
