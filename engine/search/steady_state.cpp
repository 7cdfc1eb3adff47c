#include "engine/search/steady_state.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>

namespace flyball {
namespace {

// What is found from afar, or far away, and known no better than this is no answer.
bool is_known(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& drawn,
              const Eigen::VectorXd& error) {
  double distance = 1;
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type != LinkType::spherical)
      distance = std::max(distance, std::abs(q[link.q] - drawn[link.q]) / problem.scaling.column[link.v]);
  return !(largest(error.cwiseQuotient(problem.scaling.column)) > tolerance::known * distance);
}

struct AnswerSearch {
  std::optional<Found> answer; // holds at every phase
  Existence existence;         // of the answer
  OtherStates others;
};

// Of the equilibria that a bounded search of `seconds` (see SearchOptions) finds, the one that holds at all
// `phases`, is stable if any is, and lies nearest to `start`. An answer is left evaluated and factored in the
// workspace. `problem` must be dense.
AnswerSearch search_answer(const Problem& problem, const Eigen::VectorXd& start,
                           const std::vector<double>& phases, double seconds, Workspace& w) {
  SearchOptions options;
  options.seconds = seconds;
  EquilibriumList list = find_all_equilibria(problem, start, options, w);
  AnswerSearch out;
  out.others = {.searched = true,
                .starts = list.report.starts,
                .equilibria = static_cast<int>(list.states.size()),
                .end = list.report.end};
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
  out.others.steady = static_cast<int>(steady.size());
  std::ranges::stable_sort(steady, {}, &Steady::away);
  constexpr std::size_t classified = 16; // the nearest
  for (std::size_t i = 0; i < std::min(classified, steady.size()) && !problem.cancelled(); ++i) {
    const Unknowns& z = list.states[steady[i].state];
    const Stability stability = find_stability(problem, z, false, w);
    const bool stable = stability.stable == true;
    if (out.answer && !stable) continue;
    Found found;
    found.status = Status::converged;
    found.z = z;
    found.newton = list.outcomes[steady[i].state];
    found.fallback = Fallback::search;
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

// Puts another steady state into `out` where a search finds one.
void search_another(const Problem& problem, const Eigen::VectorXd& drawn, double seconds, Workspace& w,
                    SteadyState& out) {
  const bool holds_once = out.found.status == Status::converged; // at the drawn phase
  out.others.emplace();
  if (!(seconds > 0) || problem.system.nv > largest_for_answer_search) return;
  const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
  AnswerSearch other = search_answer(dense, out.start, out.phases, seconds, w);
  out.others = other.others;
  if (!other.answer) return;
  const std::size_t recorded = out.history.size();
  Found first = std::exchange(out.found, std::move(*other.answer));
  evaluate(problem, out.found.z, 0, w);
  out.history.push_back(scaled_residual(problem, w));
  factor(problem, out.found.z, w);
  refine(problem, out.found.z, out.found.newton, w, out.error);
  if (!is_known(problem, out.found.z.q, drawn, out.error)) {
    out.history.resize(recorded);
    out.found = std::move(first);
    return;
  }
  out.found.iterations += first.iterations;
  out.existence = check_refined(problem, out.found.z, out.phases, w, out.error);
  out.holds = out.existence.holds;
  out.found.remark = holds_once ? Remark::first_does_not_hold : Remark::first_not_found;
  out.found.candidates = other.others.steady;
}

} // namespace

Existence check_refined(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                        Workspace& w, Eigen::VectorXd& error) {
  Existence existence = check_existence(problem, z.q, phases, w);
  if (!existence.holds || !(existence.left > tolerance::phase_rounding)) return existence;
  const Eigen::VectorXd away = phase_variation(problem, z, phases, w);
  error += away;
  existence.holds = largest(away.cwiseQuotient(problem.scaling.column)) < tolerance::phase_variation;
  return existence;
}

void find_steady_state(const Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& drawn,
                       const SteadyStateOptions& options, Workspace& w, SteadyState& out) {
  out.holds = false;
  out.existence = {};
  out.others.reset();
  out.start = start;
  find_equilibrium(problem, out.start, options.nearest, options.warm, w, out.history, out.found);
  // A neighbour's answer that had to be left goes back to the definition: what the drawn pose reaches.
  const bool left = out.found.status != Status::converged || out.found.fallback ||
                    (problem.symmetric() && !out.found.minimum);
  if (options.warm && left && !problem.cancelled()) {
    out.start = drawn;
    find_equilibrium(problem, out.start, options.nearest, false, w, out.history, out.found);
  }
  out.phases = sample_phases(problem.system, problem.parameters);
  if (out.found.status == Status::converged) {
    refine(problem, out.found.z, out.found.newton, w, out.error);
    if (out.found.unbounded && !is_known(problem, out.found.z.q, drawn, out.error)) {
      out.found.status = Status::not_converged;
      out.found.remark = Remark::unbounded;
    }
  }
  if (out.found.status == Status::converged) {
    out.existence = check_refined(problem, out.found.z, out.phases, w, out.error);
    out.holds = out.existence.holds;
  }
  if (out.holds || options.nearest || problem.cancelled() || problem.system.nv == 0) return;
  report_progress(options.progress, "searching for another steady state");
  search_another(problem, drawn, options.seconds, w, out);
}

} // namespace flyball
