#include "engine/equilibrium/answer_search.hpp"

#include "engine/equilibrium/refine.hpp"
#include "engine/equilibrium/stability.hpp"

#include <algorithm>

namespace flyball {

AnswerSearch search_answer(const Problem& problem, const Eigen::VectorXd& start,
                           const std::vector<double>& phases, double seconds, Workspace& w) {
  SearchOptions options;
  options.seconds = seconds;
  EquilibriumList list = find_all_equilibria(problem, start, options, w);
  AnswerSearch out;
  out.report = std::move(list.report);
  out.equilibria = static_cast<int>(list.states.size());
  struct Steady {
    std::size_t state;
    Existence existence;
    double away;
  };
  std::vector<Steady> steady;
  for (std::size_t i = 0; i < list.states.size() && !problem.cancelled(); ++i) {
    const Existence existence = check_existence(problem, list.states[i].q, phases, w);
    if (existence.holds) steady.push_back({i, existence, squared_distance(problem, list.states[i].q, start)});
  }
  out.steady = static_cast<int>(steady.size());
  std::ranges::stable_sort(steady, {}, &Steady::away);
  constexpr std::size_t judged = 16; // the nearest
  for (std::size_t i = 0; i < std::min(judged, steady.size()) && !problem.cancelled(); ++i) {
    const Unknowns& z = list.states[steady[i].state];
    const Stability stability = find_stability(problem, z, false, w);
    const bool stable = stability.stable == true;
    if (out.answer && !stable) continue;
    Found found;
    found.status = Status::converged;
    found.z = z;
    found.newton = list.outcomes[steady[i].state];
    found.net = Net::search;
    found.minimum = stability.reason == StabilityReason::minimum;
    found.iterations = found.newton.iterations;
    out.answer = std::move(found);
    out.existence = steady[i].existence;
    if (stable) break;
  }
  if (out.answer) {
    evaluate(problem, out.answer->z, 0, w);
    factor(problem, out.answer->z, w);
  }
  return out;
}

void find_steady_state(const Problem& problem, const Eigen::VectorXd& start, double seconds, Workspace& w,
                       SteadyState& out) {
  out.holds = false;
  out.existence = {};
  out.tried.clear();
  out.phases = sample_phases(problem.system, problem.parameters);
  const auto judge = [&] {
    if (out.found.status != Status::converged) return;
    refine(problem, out.found.z, out.found.newton, w, out.error);
    out.existence = check_existence(problem, out.found.z.q, out.phases, w);
    out.holds = out.existence.holds;
  };
  find_equilibrium(problem, start, false, false, w, out.history, out.found);
  judge();
  const int nv = problem.system.nv;
  if (out.holds || problem.cancelled() || nv == 0 || nv > largest_for_answer_search) return;
  AnswerSearch other = search_answer(problem, start, out.phases, seconds, w);
  if (!other.answer) {
    out.tried = describe(other);
    return;
  }
  other.answer->iterations += out.found.iterations;
  out.found = std::move(*other.answer);
  judge();
}

std::string describe(const AnswerSearch& search) {
  const std::string runs = std::to_string(search.report.starts) + " starts all over the coordinates' ranges";
  if (search.report.end == SearchEnd::cancelled) return "The search for others was cancelled.";
  const std::string more =
      search.report.end == SearchEnd::settled ? "" : " The search was short; solve --all looks for longer.";
  if (search.equilibria == 0) return "A search from " + runs + " found none either." + more;
  return (search.equilibria == 1
              ? "It is the only equilibrium of the drawn phase"
              : "None of the " + std::to_string(search.equilibria) + " equilibria of the drawn phase") +
         " found from " + runs + (search.equilibria == 1 ? "." : " holds at every phase.") + more;
}

} // namespace flyball
