#include "engine/search/steady_state.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/singular_loops.hpp"
#include "engine/solve/slow_motion.hpp"
#include "engine/stability/sign_is_open.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace flyball {
namespace {

constexpr double half_a_turn = 3;            // scaled, about: or the reach
constexpr double search_beside_answer = 0.3; // s, of what a search costs where there is an answer already

// What is found from afar, or far away, and known no better than this is no answer.
bool is_known(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& drawn,
              const Eigen::VectorXd& error) {
  double distance = 1;
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type != LinkType::spherical)
      distance = std::max(distance, std::abs(q[link.q] - drawn[link.q]) / problem.scaling.column[link.v]);
  return !(largest(error.cwiseQuotient(problem.scaling.column)) > tolerance::known * distance);
}

// How far (scaled) what has no speed to be found went from a to b.
double way_between(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd way = scaled_difference(problem, a, b);
  for (const Link& link : problem.system.links)
    if (finds_speed(link)) way[link.v] = 0;
  return largest_size(way);
}

// Whether Newton-Raphson went so far from a to b that it may have passed by what a motion from a comes to:
// about half a turn or the reach, or less while a speed became another altogether.
bool went_far(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  constexpr double far_with_speeds = 0.5; // scaled
  const double way = way_between(problem, a, b);
  return way > half_a_turn ||
         (way > far_with_speeds && std::ranges::any_of(problem.system.links, [&](const Link& link) {
            return finds_speed(link) &&
                   std::abs(b[link.q] - a[link.q]) > 0.5 * std::max(std::abs(a[link.q]), std::abs(b[link.q]));
          }));
}

struct AnswerSearch {
  std::optional<Found> answer; // holds at every phase
  OtherStates others;
};

// Of the equilibria that a bounded search of `seconds` (see SearchOptions) finds, the one that holds at all
// phases, is stable if any is, and lies nearest to `start`. `problem` must be dense.
AnswerSearch search_answer(const Problem& problem, const Eigen::VectorXd& start, double seconds,
                           Workspace& w) {
  SearchOptions options;
  options.seconds = seconds;
  EquilibriumList list = find_all_equilibria(problem, start, options, w);
  AnswerSearch out;
  out.others = {.searched = true,
                .starts = list.report.starts,
                .equilibria = static_cast<int>(list.states.size()),
                .end = list.report.end,
                .fastest = list.report.fastest,
                .fastest_turns = list.report.fastest_turns};
  struct Steady {
    std::size_t state;
    double distance;
  };
  std::vector<Steady> steady;
  for (std::size_t i = 0; i < list.states.size() && !problem.cancelled(); ++i) {
    const Eigen::VectorXd& q = list.states[i].q;
    if (check_existence(problem, q, sample_phases(problem.system, problem.parameters, q), w).holds)
      steady.push_back({i, squared_distance(problem, q, start)});
  }
  out.others.steady = static_cast<int>(steady.size());
  std::ranges::stable_sort(steady, {}, &Steady::distance);
  constexpr std::size_t classified = 16; // the nearest
  for (std::size_t i = 0; i < std::min(classified, steady.size()) && !problem.cancelled(); ++i) {
    const Unknowns& z = list.states[steady[i].state];
    const Stability stability = find_stability(factor_at(problem, z, w), false);
    const bool stable = stability.stable == true;
    if (out.answer && !stable) continue;
    Found& found = out.answer.emplace();
    found.status = Status::converged;
    found.z = z;
    found.newton = list.outcomes[steady[i].state];
    found.fallback = Fallback::search;
    found.minimum = stability.reason == StabilityReason::minimum;
    found.iterations = found.newton.iterations;
    if (stable) break;
  }
  return out;
}

} // namespace

void SteadyState::find(const Problem& problem, const Eigen::VectorXd& from, const Eigen::VectorXd& drawn,
                       const SteadyStateOptions& options) {
  if (const int link = rubbing_link(problem.system, problem.parameters); link >= 0)
    return refuse(problem, from, {.holds = false, .rubs = link});
  find_once(problem, from, drawn, options);
  if (options.nearest || problem.cancelled() || problem.system.nv == 0) return;
  if (!holds) {
    report_progress(options.progress, "searching for another steady state");
    search_another(problem, drawn, options.seconds);
    return;
  }
  if (options.newton_only || problem.system.torques.empty() || (found.minimum && phases.empty())) return;
  judge(problem);
  if (!unstable_) {
    if (options.warm || problem.system.nv > largest_for_answer_search || !went_far(problem, start, found.z.q))
      return;
    leave_far(problem, drawn, options);
    return;
  }
  if (options.warm) {
    SteadyStateOptions cold = options;
    cold.warm = false;
    find(problem, drawn, drawn, cold);
  } else {
    leave_unstable(problem, drawn, options);
  }
}

// The start is told as a state that does not hold, for whatever reason of the mechanism.
void SteadyState::refuse(const Problem& problem, const Eigen::VectorXd& from, Existence why) {
  found = {};
  found.status = Status::converged;
  found.z = {from, Eigen::VectorXd::Zero(problem.system.rows)};
  existence = why;
  holds = unstable_ = false;
  others.reset();
  stability.reset();
  phases.clear();
  history.clear();
  start = from;
  error = {};
  factored_.reset();
  refined_with_.reset();
}

void SteadyState::find_once(const Problem& problem, const Eigen::VectorXd& from, const Eigen::VectorXd& drawn,
                            const SteadyStateOptions& options) {
  holds = false;
  factored_.reset();
  refined_with_.reset();
  existence = {};
  others.reset();
  stability.reset();
  unstable_ = false;
  start = from;
  find_equilibrium(problem, start, options.nearest, options.warm, balance_, history, found,
                   options.newton_only);
  // A neighbour's answer that had to be left goes back to the definition: what the drawn pose reaches.
  const bool left = found.status != Status::converged || found.fallback ||
                    (problem.symmetric() && !found.minimum && !problem.parameters.dampers_drive);
  if (options.warm && left && !problem.cancelled()) {
    start = drawn;
    find_equilibrium(problem, start, options.nearest, false, balance_, history, found, options.newton_only);
  }
  phases = sample_phases(problem.system, problem.parameters, found.z.q);
  if (found.status == Status::converged) {
    keep_where_started(problem);
    refine_found(problem);
    if (error.singular_loops && passes_singular_loops(problem, found.z, balance_))
      found.status = Status::not_converged;
    if (found.unbounded && !is_known(problem, found.z.q, drawn, error.solution)) {
      found.status = Status::not_converged;
      found.remark = Remark::unbounded;
    }
  }
  if (found.status == Status::converged) check_phases(problem);
}

// What rounding did to a coordinate that neither forces nor loops depend on is taken back.
void SteadyState::keep_where_started(const Problem& problem) {
  constexpr double nothing = 1e-12; // scaled
  still_.clear();
  const DenseKkt* dense = balance_.matrices(problem);
  if (!dense || !dense->singular()) return;
  const auto free = [&](int v) {
    return largest_size(dense->stiffness().col(v)) <= nothing &&
           (problem.system.rows == 0 || largest_size(dense->jacobian().col(v)) <= nothing);
  };
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && link.type != LinkType::spherical && !finds_speed(link) && free(link.v))
      still_.push_back(link.q);
  if (still_.empty()) return;
  Unknowns kept = found.z;
  for (const int q : still_)
    kept.q[q] = start[q];
  if (kept.q == found.z.q) return;
  factor_at(problem, kept, balance_);
  if (scaled_residual(problem, balance_) <= nothing) {
    found.z = kept;
  } else {
    still_.clear();
    factor_at(problem, found.z, balance_);
  }
}

void SteadyState::complete(const Problem& problem) {
  still_.clear();
  phases = sample_phases(problem.system, problem.parameters, found.z.q);
  factor_at(problem, found.z, balance_);
  history.push_back(scaled_residual(problem, balance_));
  refine_found(problem);
  check_phases(problem);
}

FactoredState SteadyState::factored(const Problem& problem) {
  if (factored_ == problem.form) return {problem, found.z, balance_};
  factored_ = problem.form;
  // Inertia and steps of many bodies do not depend on the last correction, and where torques drive
  // eigenvalues do not: their factors serve on.
  const bool serves = problem.form != KktForm::dense || !problem.system.torques.empty();
  if (serves && problem.form == refined_with_) {
    evaluate(problem, found.z, 0, balance_);
    return {problem, found.z, balance_};
  }
  return factor_at(problem, found.z, balance_, problem.form == KktForm::dense ? 0 : shift_);
}

// From the balance factored beside it.
void SteadyState::refine_found(const Problem& problem) {
  refine(problem, found.z, found.newton, balance_, error);
  for (const int q : still_)
    found.z.q[q] = start[q];
  shift_ = balance_.kkt(problem).shift();
  refined_with_ = problem.form;
  factored_.reset();
}

void SteadyState::check_phases(const Problem& problem) {
  existence = check_existence(problem, found.z.q, phases, balance_.elsewhere());
  if (existence.holds && existence.left > tolerance::phase_rounding) {
    const Eigen::VectorXd variation = phase_variation(problem, found.z, phases, balance_.elsewhere());
    const double varies = largest(variation.cwiseQuotient(problem.scaling.column)),
                 known = largest((error.solution + error.data).cwiseQuotient(problem.scaling.column));
    error.solution += variation;
    existence.holds = varies < tolerance::phase_variation;
    existence.varies = existence.holds && varies > std::max(tolerance::phase_stands, 100 * known);
  }
  holds = existence.holds;
}

// Of many coordinates the pivots at the speeds found have to do, where there are any.
void SteadyState::judge(const Problem& problem) {
  unstable_ = false;
  if (problem.system.nv > largest_for_answer_search) {
    unstable_ = problem.symmetric_at_speeds() && balance_.kkt(problem).negative_count() > 0;
    return;
  }
  const Problem matrices{problem.system, problem.parameters, problem.scaling, problem.cancel};
  stability = find_stability(factored(matrices), false);
  unstable_ = stability->stable == false &&
              !sign_is_open(matrices, found.z, error.solution, *stability, balance_.elsewhere());
}

// Puts the stable state that the slow motion from the start comes to in the place of this one, to which
// Newton-Raphson went past it.
void SteadyState::leave_far(const Problem& problem, const Eigen::VectorXd& drawn,
                            const SteadyStateOptions& options) {
  Found candidate;
  candidate.z = {start, Eigen::VectorXd::Zero(problem.system.rows)};
  candidate.newton = follow_slow_motion(problem, candidate.z, balance_.elsewhere(), nullptr);
  if (problem.cancelled() || !candidate.newton.converged ||
      !same_assembly_mode(problem, balance_.elsewhere().kinematics) || !is_nearer(problem, candidate.z))
    return;
  candidate.status = Status::converged;
  candidate.fallback = Fallback::slow_motion;
  candidate.iterations = found.iterations + candidate.newton.iterations;
  if (!take_if_stable(problem, drawn, std::move(candidate))) search_nearer(problem, drawn, options);
}

// Where the state beside the start hunts, one turns away from it is no more of an answer than the nearest
// stable one that a search finds, which is put in its place.
void SteadyState::search_nearer(const Problem& problem, const Eigen::VectorXd& drawn,
                                const SteadyStateOptions& options) {
  if (!(options.seconds > 0) || problem.system.nv > largest_for_answer_search ||
      !(way_between(problem, start, found.z.q) > half_a_turn))
    return;
  const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
  AnswerSearch other =
      search_answer(dense, start, std::min(options.seconds, search_beside_answer), balance_.elsewhere());
  if (problem.cancelled() || !other.answer || !is_nearer(problem, other.answer->z)) return;
  other.answer->remark = found.remark;
  other.answer->candidates = other.others.steady;
  other.answer->iterations += found.iterations;
  take_if_stable(problem, drawn, std::move(*other.answer));
}

bool SteadyState::is_nearer(const Problem& problem, const Unknowns& z) const {
  return way_between(problem, start, z.q) < 0.8 * way_between(problem, start, found.z.q);
}

// Puts one that is not unstable in the place of this state, which is, where the slow motion leads to one:
// from the start, or from either side of this state; or else where a search finds one.
void SteadyState::leave_unstable(const Problem& problem, const Eigen::VectorXd& drawn,
                                 const SteadyStateOptions& options) {
  report_progress(options.progress, "leaving an unstable state");
  Workspace& w = balance_.elsewhere();
  int iterations = found.iterations;
  const auto take = [&](Found candidate) {
    candidate.iterations += iterations;
    candidate.remark = Remark::left_unstable_speeds;
    return take_if_stable(problem, drawn, std::move(candidate));
  };
  constexpr double beside = 0.01; // scaled
  for (const double side : {0., beside, -beside}) {
    Found candidate;
    candidate.z = {side == 0 ? start : found.z.q, Eigen::VectorXd::Zero(problem.system.rows)};
    const Eigen::VectorXd step = side * problem.scaling.column;
    retract<double>(problem.system, step, candidate.z.q);
    candidate.newton = follow_slow_motion(problem, candidate.z, w, nullptr);
    if (problem.cancelled()) return;
    iterations += candidate.newton.iterations;
    if (!candidate.newton.converged || !same_assembly_mode(problem, w.kinematics)) continue;
    candidate.status = Status::converged;
    candidate.fallback = Fallback::slow_motion;
    if (!take(std::move(candidate))) continue;
    if (side != 0) search_nearer(problem, drawn, options);
    return;
  }
  // What grows in swings alone is not left for another state but hunts about this one.
  const auto swings = [](std::complex<double> s) { return !(s.real() > 0) || s.imag() != 0; };
  if (stability && stability->eigenvalues && std::ranges::all_of(*stability->eigenvalues, swings)) return;
  if (!(options.seconds > 0) || problem.system.nv > largest_for_answer_search) return;
  const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
  AnswerSearch other = search_answer(dense, start, std::min(options.seconds, search_beside_answer), w);
  if (!other.answer || problem.cancelled()) return;
  other.answer->candidates = other.others.steady;
  take(std::move(*other.answer));
}

SteadyState::Answer SteadyState::replace(const Problem& problem, Found candidate) {
  Answer before{std::exchange(found, std::move(candidate)),
                phases,
                existence,
                error,
                std::exchange(stability, std::nullopt),
                holds,
                std::exchange(unstable_, false),
                history.size()};
  complete(problem);
  return before;
}

void SteadyState::put_back(Answer answer) {
  found = std::move(answer.found);
  phases = std::move(answer.phases);
  existence = std::move(answer.existence);
  error = std::move(answer.error);
  stability = std::move(answer.stability);
  holds = answer.holds;
  unstable_ = answer.unstable;
  history.resize(answer.recorded);
  factored_.reset();
  refined_with_.reset();
}

// In the place of this state; false, and this one as it was, where that is unstable, too, or not known well.
bool SteadyState::take_if_stable(const Problem& problem, const Eigen::VectorXd& drawn, Found candidate) {
  Answer before = replace(problem, std::move(candidate));
  if (holds && is_known(problem, found.z.q, drawn, error.solution)) {
    found.minimum = found.minimum || (problem.symmetric_at_speeds() && balance_.speeds.keeps_minimum() &&
                                      !problem.parameters.dampers_drive);
    if (!found.minimum || !phases.empty()) judge(problem);
    if (!unstable_ || (found.minimum && phases.empty())) return true;
  }
  put_back(std::move(before));
  return false;
}

// Puts another steady state in this one's place where a search finds one.
void SteadyState::search_another(const Problem& problem, const Eigen::VectorXd& drawn, double seconds) {
  const bool holds_once = found.status == Status::converged; // at the drawn phase
  others.emplace();
  if (!(seconds > 0) || problem.system.nv > largest_for_answer_search) return;
  const Problem dense{problem.system, problem.parameters, problem.scaling, problem.cancel};
  AnswerSearch other = search_answer(dense, start, seconds, balance_.elsewhere());
  others = other.others;
  if (!other.answer) return;
  Answer first = replace(problem, std::move(*other.answer));
  if (!is_known(problem, found.z.q, drawn, error.solution)) return put_back(std::move(first));
  found.iterations += first.found.iterations;
  found.remark = holds_once ? Remark::first_does_not_hold : Remark::first_not_found;
  found.candidates = others->steady;
}

} // namespace flyball
