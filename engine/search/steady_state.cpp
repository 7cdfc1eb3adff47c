#include "engine/search/steady_state.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

constexpr double phase_rounding = 64 * std::numeric_limits<double>::epsilon();
constexpr double most_phase_variation = 1e-2; // scaled; what moves further with the drives does not stand

// What is found from afar, or far away, and known no better than this is no answer.
bool is_known(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& drawn,
              const Eigen::VectorXd& error) {
  constexpr double most = 1e-6; // of the reach, or of the distance where it is longer
  double distance = 1;
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type != LinkType::spherical)
      distance = std::max(distance, std::abs(q[link.q] - drawn[link.q]) / problem.scaling.column[link.v]);
  return !(largest(error.cwiseQuotient(problem.scaling.column)) > most * distance);
}

// Puts another steady state into `out` where search_answer() finds one; else tells what was tried.
std::string search_another(const Problem& problem, const Eigen::VectorXd& drawn, double seconds, Workspace& w,
                           SteadyState& out) {
  const bool fails_later = out.found.status == Status::converged;
  if (!(seconds > 0) || problem.system.nv > largest_for_answer_search)
    return std::string(fails_later ? "That is said of the equilibrium found from this start alone; "
                                   : "No other start was tried; ") +
           "solve --all looks for others.";
  if (problem.system.nv == 0) return "";
  const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
  AnswerSearch other = search_answer(dense, out.start, out.phases, seconds, w);
  if (!other.answer) return describe(other);
  const std::size_t recorded = out.history.size();
  Found first = std::exchange(out.found, std::move(*other.answer));
  evaluate(problem, out.found.z, 0, w);
  out.history.push_back(scaled_residual(problem, w));
  factor(problem, out.found.z, w);
  refine(problem, out.found.z, out.found.newton, w, out.error);
  if (!is_known(problem, out.found.z.q, drawn, out.error)) {
    out.history.resize(recorded);
    out.found = std::move(first);
    return describe(other);
  }
  out.found.iterations += first.iterations;
  out.existence = check_refined(problem, out.found.z, out.phases, w, out.error);
  out.holds = out.existence.holds;
  out.found.message = (fails_later ? "The equilibrium found first holds at one phase of the drives only"
                                   : "Newton-Raphson and its nets led nowhere from the start") +
                      std::string("; a search all over the coordinates' ranges found this steady state") +
                      (other.steady > 1 ? ", the nearest of " + std::to_string(other.steady) + "." : ".");
  return "";
}

} // namespace

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

Existence check_refined(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                        Workspace& w, Eigen::VectorXd& error) {
  Existence existence = check_existence(problem, z.q, phases, w);
  if (!existence.holds || !(existence.left > phase_rounding)) return existence;
  const Eigen::VectorXd away = phase_variation(problem, z, phases, w);
  error += away;
  existence.holds = largest(away.cwiseQuotient(problem.scaling.column)) < most_phase_variation;
  return existence;
}

void find_steady_state(const Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& drawn,
                       const SteadyStateOptions& options, Workspace& w, SteadyState& out) {
  out.holds = false;
  out.existence = {};
  out.tried.clear();
  out.start = start;
  find_equilibrium(problem, out.start, options.nearest, options.warm, w, out.history, out.found);
  // A neighbour's answer that had to be left goes back to the definition: what the drawn pose reaches.
  const bool left =
      out.found.status != Status::converged || out.found.net || (problem.symmetric() && !out.found.minimum);
  if (options.warm && left && !problem.cancelled()) {
    out.start = drawn;
    find_equilibrium(problem, out.start, options.nearest, false, w, out.history, out.found);
  }
  out.phases = sample_phases(problem.system, problem.parameters);
  if (out.found.status == Status::converged) {
    refine(problem, out.found.z, out.found.newton, w, out.error);
    if (out.found.fell && !is_known(problem, out.found.z.q, drawn, out.error)) {
      out.found.status = Status::not_converged;
      out.found.message = "The potential falls on, hundreds of times the mechanism's reach away.";
    }
  }
  if (out.found.status == Status::converged) {
    out.existence = check_refined(problem, out.found.z, out.phases, w, out.error);
    out.holds = out.existence.holds;
  }
  if (out.holds || options.nearest || problem.cancelled()) return;
  report_progress(options.progress, "searching for another steady state");
  out.tried = search_another(problem, drawn, options.seconds, w, out);
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
