#include "engine/study/steady_map.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/branches.hpp"
#include "engine/kkt/configuration_difference.hpp"
#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/report/turned_measures.hpp"
#include "engine/search/turned_rates.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/existence.hpp"
#include "engine/solve/sensitivity.hpp"
#include "engine/stability/neutral_directions.hpp"
#include "engine/study/counted_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

// Scaled, of the state.
constexpr double longest_correction = 0.25; // where it was predicted: more has left the branch
constexpr double longest_way = 0.3;         // in one step
constexpr int most_halvings = 12;           // of steps that the state does not follow
constexpr double led_within = 0.6;          // of both rates' steps: of a kink less than half
constexpr double led_rounding = 1e-6;       // of coordinates, scaled

Solution steady_state_near(const Mechanism& mechanism,
                           const std::vector<std::pair<std::string, double>>& start,
                           const std::atomic<bool>* cancel) {
  SolveOptions solve;
  solve.start = start;
  solve.nearest = !start.empty();
  solve.details = false;
  solve.cancel = cancel;
  Analysis analysis(mechanism);
  Solution out = analysis.solve(solve);
  if (out.status == Status::converged || start.empty()) return out;
  solve.start.clear();
  solve.nearest = false;
  Solution answer = analysis.solve(solve);
  return answer.turned ? answer : out;
}

SteadyMap::SteadyMap(const Mechanism& mechanism, std::span<const FreeNumber> free,
                     std::vector<std::string> wanted, const std::atomic<bool>* cancel)
    : varied_(mechanism), cancel_(cancel) {
  if (free.empty()) throw SceneError("free numbers", "expected one or more");
  const auto n = static_cast<Eigen::Index>(free.size());
  lower_.resize(n);
  upper_.resize(n);
  p_.resize(n);
  std::vector<NumberRange> ranges;
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeNumber& number = free[static_cast<std::size_t>(i)];
    const double value = get_parameter(mechanism, number.address);
    if (!(number.from < number.to)) throw SceneError(number.address, "expected a range from < to");
    if (std::ranges::find(addresses_, number.address) != addresses_.end())
      throw SceneError(number.address, "expected each number once");
    expect_no_found_speed(mechanism, number.address);
    addresses_.push_back(number.address);
    ranges.push_back({number.address, number.from, number.to});
    lower_[i] = number.from;
    upper_[i] = number.to;
    p_[i] = std::clamp(value, number.from, number.to);
  }
  range_ = upper_ - lower_;
  numbers_.emplace(varied_, addresses_);
  system_ = compile_for_drives(inside_ranges(mechanism, ranges).value_or(mechanism));
  for (const std::string& name : wanted)
    wanted_.push_back(find_wanted(mechanism, system_, name));
}

bool SteadyMap::measures_wanted() const {
  return std::ranges::any_of(wanted_, [](const Wanted& w) { return !w.coordinate; });
}

// Throws SceneError where no mechanism can be made of them.
void SteadyMap::set(const Eigen::VectorXd& p, const Eigen::VectorXd& q) {
  numbers_->set({p.data(), static_cast<std::size_t>(p.size())});
  validate_numbers(varied_);
  bind(system_, varied_, parameters_);
  set_scaling(system_, parameters_, scaling_);
  for (const DriveTorqueElement& torque : system_.torques) {
    const Link& link = system_.links[static_cast<std::size_t>(torque.link)];
    if (q.size() > 0) scaling_.column[link.v] = std::max(scaling_.column[link.v], std::abs(q[link.q]));
  }
}

void SteadyMap::set(const State& state) {
  set(state.p, state.z.q);
  if (state.turned) parameters_ = at_angles_of(parameters_, *state.turned);
}

void SteadyMap::find_values(State& state) {
  const Eigen::VectorXd* measured = nullptr;
  if (measures_wanted()) {
    measures_.bind(varied_, system_, parameters_);
    measured = &measures_.evaluate_at(problem(), state.z.q, w_);
  }
  state.values.resize(static_cast<Eigen::Index>(wanted_.size()));
  for (std::size_t i = 0; i < wanted_.size(); ++i)
    state.values[static_cast<Eigen::Index>(i)] =
        is_open(i)              ? std::numeric_limits<double>::quiet_NaN()
        : wanted_[i].coordinate ? found_value(system_, parameters_, state.z.q, *wanted_[i].coordinate)
                                : (*measured)[static_cast<Eigen::Index>(wanted_[i].measure)];
}

void SteadyMap::find_values(State& state, const State& from) {
  find_values(state);
  if (!keeps_to_branch_) return;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double predicted = from.values[k] + rates_.row(k).dot(state.p - from.p);
    if (!wanted_[i].coordinate && unit(i) == "rad" && std::isfinite(predicted))
      state.values[k] = counted_on(state.values[k], predicted);
  }
}

bool SteadyMap::follow_across(State& state) {
  constexpr double some = 0.3, alike = 1e-8; // scaled: a step along the family; of a value
  if (state.turned || !w_.matrices(problem())) return false;
  set(state);
  const FactoredState at = factor_at(problem(), state.z, w_);
  const Eigen::MatrixXd null_space = w_.dense.constraints().basis() * w_.dense.hessian().null_basis();
  const NeutralDirections neutral = neutral_directions(at, null_space);
  if (neutral.count == 0 || neutral.count < null_space.cols()) return false;
  std::vector<bool> open(wanted_.size());
  for (Eigen::Index c = 0; c < neutral.count; ++c)
    for (const double side : {some, -some}) {
      State beside{state.p, state.z, {}, {}};
      const Eigen::VectorXd step = side * neutral.directions.col(c).cwiseProduct(scaling_.column);
      retract<double>(system_, step, beside.z.q);
      if (!assemble(problem(), beside.z.q, 0, w_) || !correct(beside.z)) return false;
      find_values(beside);
      for (std::size_t i = 0; i < open.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double size = std::max(std::abs(state.values[k]), scale(i).value_or(0));
        open[i] = open[i] || !(std::abs(beside.values[k] - state.values[k]) <= alike * size);
      }
    }
  across_ = true;
  open_ = std::move(open);
  find_values(state);
  return true;
}

std::optional<SteadyMap::State> SteadyMap::begin(const std::vector<std::pair<std::string, double>>& start,
                                                 Solution& first) {
  set(p_, {});
  first = steady_state_near(varied_, start, cancel_);
  if (first.status != Status::converged) return std::nullopt;
  if (!first.frictions.empty()) { // rates of what rests on it are none
    first.status = Status::no_steady_state;
    first.message = rests_on_friction(first, "How it changes with numbers is found");
    return std::nullopt;
  }
  if (first.turned) return begin_turned();
  State state{p_, {configuration_of(problem(), first.coordinates), {}}, {}, {}};
  if (!correct(state.z)) { // neutral, say: the state itself is known
    state.z.q = configuration_of(problem(), first.coordinates);
    evaluate_with_multipliers(problem(), state.z, w_);
  }
  find_values(state);
  return state;
}

// The one that solving answers.
std::optional<SteadyMap::State> SteadyMap::begin_turned() {
  Eigen::VectorXd drawn;
  drawn_configuration(system_, parameters_, drawn);
  std::optional<TurnedState> turned = find_turned_state(dense(), drawn, w_);
  if (!turned) return std::nullopt;
  State state{p_, turned->z, {}, std::move(turned)};
  set(state);
  find_values(state);
  return state;
}

std::optional<SteadyMap::State> SteadyMap::step_to_turned(const State& from, const Eigen::VectorXd& p) {
  set(p, from.z.q);
  std::optional<TurnedState> turned = find_turned_state_beside(dense(), *from.turned, w_);
  if (!turned || !turned->z.q.allFinite() ||
      largest_size(scaled_difference(dense(), from.z.q, turned->z.q)) > 2 * longest_way)
    return std::nullopt;
  State to{p, turned->z, {}, std::move(turned)};
  set(to);
  if (!check_existence(dense(), to.z.q, sample_phases(system_, parameters_, to.z.q), w_).holds)
    return std::nullopt;
  find_values(to, from);
  return to;
}

bool SteadyMap::find_turned_rates(const State& state) {
  const Problem p = dense();
  const std::vector<TurnedRate> found = turned_rates(p, state.z, state.turned->ties, varied_, *numbers_, w_);
  if (found.empty() || std::ranges::any_of(found, [](const TurnedRate& r) { return r.q.size() == 0; }))
    return false;
  state_rates_.resize(system_.nv, count());
  rates_.resize(static_cast<Eigen::Index>(wanted_.size()), count());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    state_rates_.col(column) = found[k].q;
    Eigen::VectorXd measured;
    if (measures_wanted())
      measured = turned_measure_rates(p, state.z.q, found[k], measures_, varied_, *numbers_, k, w_);
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      rates_(static_cast<Eigen::Index>(i), column) =
          wanted_[i].coordinate
              ? found_gradient(system_, parameters_, state.z.q, *wanted_[i].coordinate).dot(found[k].q)
              : measured[static_cast<Eigen::Index>(wanted_[i].measure)];
  }
  return true;
}

bool SteadyMap::correct(Unknowns& z) {
  const Problem p = problem();
  evaluate_with_multipliers(p, z, w_);
  NewtonSettings settings;
  settings.max_iterations = 12;
  const NewtonOutcome outcome = newton(p, z, w_, settings, nullptr);
  return outcome.converged && outcome.largest_step < longest_correction;
}

bool SteadyMap::find_rates(const State& state) try {
  if (state_rates_.cols() > 0 && state.p == rated_p_ && state.z.q == rated_q_)
    return state_rates_.allFinite();
  state_rates_.resize(0, 0);
  set(state);
  if (state.turned) {
    if (!find_turned_rates(state)) return false;
    rated_p_ = state.p;
    rated_q_ = state.z.q;
    rated_scale_ = scaling_.column;
    return state_rates_.allFinite();
  }
  const Problem p = problem();
  const FactoredState factored = factor_at(p, state.z, w_);
  negative_ = factored.kkt().negative_count();
  const std::vector<Eigen::VectorXd> found = sensitivities(factored, varied_, *numbers_, across_);
  if (found.empty() ||
      !std::ranges::all_of(found, [&](const Eigen::VectorXd& rate) { return rate.size() == system_.nv; }))
    return false;
  state_rates_.resize(system_.nv, count());
  for (Eigen::Index k = 0; k < count(); ++k)
    state_rates_.col(k) = found[static_cast<std::size_t>(k)];
  rates_.resize(static_cast<Eigen::Index>(wanted_.size()), count());
  Eigen::MatrixXd measured;
  if (measures_wanted()) measured = measures_.rates_along(p, varied_, *numbers_, state.z.q, found, w_);
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (wanted_[i].coordinate)
      rates_.row(row) =
          found_gradient(system_, parameters_, state.z.q, *wanted_[i].coordinate).transpose() * state_rates_;
    else
      rates_.row(row) = measured.row(static_cast<Eigen::Index>(wanted_[i].measure));
    if (is_open(i)) rates_.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  rated_p_ = state.p;
  rated_q_ = state.z.q;
  rated_scale_ = scaling_.column;
  return state_rates_.allFinite();
} catch (const SceneError&) { // beside it no mechanism can be made
  return false;
}

double SteadyMap::way(const Eigen::VectorXd& step) const {
  if (system_.nv == 0) return 0;
  return (state_rates_ * step).cwiseQuotient(rated_scale_).lpNorm<Eigen::Infinity>();
}

std::optional<SteadyMap::State> SteadyMap::step_to(const State& from, const Eigen::VectorXd& p) {
  try {
    if (from.turned) return step_to_turned(from, p);
    set(p, from.z.q);
  } catch (const SceneError&) {
    return std::nullopt;
  }
  State to{p, from.z, {}, {}};
  retract<double>(system_, state_rates_ * (p - from.p), to.z.q);
  if (!correct(to.z)) return std::nullopt;
  // Past a fold, or where branches cross, the steady states are others.
  if (problem().symmetric() && factor_at(problem(), to.z, w_).kkt().negative_count() != negative_)
    return std::nullopt;
  find_values(to, from);
  return to;
}

// Whether rates at both ends lead from one state to the other. Past two folds, as where a spring's force
// falls and rises again, the inertia of the balance is as before.
bool SteadyMap::goes_on(const State& from, const Eigen::MatrixXd& state_rates, const State& to) const {
  if (system_.nv == 0 || from.turned || to.turned) return true;
  const Eigen::VectorXd step = to.p - from.p;
  const Eigen::ArrayXd a = (state_rates * step).cwiseQuotient(rated_scale_).array(),
                       b = (state_rates_ * step).cwiseQuotient(rated_scale_).array();
  const Eigen::ArrayXd change = scaled_difference(problem(), from.z.q, to.z.q).array();
  return ((change - (a + b) / 2).abs() <= led_within * (a.abs() + b.abs()).maxCoeff() + led_rounding).all();
}

// Measures that rates at both ends do not lead from one value to the other.
void SteadyMap::look_for_jumps(const State& from, const Eigen::MatrixXd& before, const State& to) {
  jumps_.resize(wanted_.size(), false);
  if (!find_rates(to)) return;
  const Eigen::MatrixXd after = rates_;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (wanted_[i].coordinate || jumps_[i]) continue;
    jumps_[i] = may_jump(i, from, before.row(k), to, after.row(k)) && is_jump(i, from, to);
  }
}

bool SteadyMap::may_jump(std::size_t wanted, const State& from, const Eigen::VectorXd& rate_from,
                         const State& to, const Eigen::VectorXd& rate_to) const {
  const auto k = static_cast<Eigen::Index>(wanted);
  const Eigen::VectorXd step = to.p - from.p;
  const double a = rate_from.dot(step), b = rate_to.dot(step), change = to.values[k] - from.values[k];
  if (!std::isfinite(a + b + change)) return false;
  const double rounding = 1e-9 * (std::abs(to.values[k]) + std::abs(from.values[k]));
  return std::abs(change - (a + b) / 2) > led_within * (std::abs(a) + std::abs(b)) + rounding;
}

// By halving: what is steep is smooth near by.
bool SteadyMap::is_jump(std::size_t wanted, State from, State to) {
  constexpr int halvings = 30;
  const auto k = static_cast<Eigen::Index>(wanted);
  for (int i = 0; i < halvings; ++i) {
    interruption_point();
    if (!find_rates(to)) return false;
    const Eigen::VectorXd rate_to = rates_.row(k);
    if (!find_rates(from)) return false;
    const Eigen::VectorXd rate_from = rates_.row(k);
    std::optional<State> middle = step_to(from, (from.p + to.p) / 2);
    if (!middle || !find_rates(*middle)) return false;
    const Eigen::VectorXd rate = rates_.row(k);
    if (may_jump(wanted, from, rate_from, *middle, rate))
      to = std::move(*middle);
    else if (may_jump(wanted, *middle, rate, to, rate_to))
      from = std::move(*middle);
    else
      return false;
  }
  return true;
}

// From the state whose rates were found last; see keep_to_branch().
std::optional<SteadyMap::State> SteadyMap::step_along_branch(const State& from, const Eigen::VectorXd& p) {
  const Eigen::MatrixXd rates = rates_, state_rates = state_rates_;
  std::optional<State> to = step_to(from, p);
  if (!to || (find_rates(*to) && !goes_on(from, state_rates, *to))) return std::nullopt;
  if (measures_wanted()) look_for_jumps(from, rates, *to);
  return to;
}

bool SteadyMap::walk_to(State& state, const Eigen::VectorXd& p) {
  double part = 1;
  for (int halvings = 0; state.p != p && halvings <= most_halvings;) {
    interruption_point();
    if (!find_rates(state)) return false;
    const double there = way(p - state.p);
    const double step = std::min(part, there > longest_way ? longest_way / there : 1);
    const Eigen::VectorXd to = step == 1 ? p : (state.p + step * (p - state.p)).eval();
    if (to == state.p) return false; // the state runs away at numbers that are told apart no more
    std::optional<State> next = keeps_to_branch_ ? step_along_branch(state, to) : step_to(state, to);
    if (next) {
      state = std::move(*next);
      part = std::min(1., 2 * part);
    } else {
      part = step / 2;
      ++halvings;
    }
  }
  return state.p == p;
}

Solution SteadyMap::solution(const State& state, bool details) {
  set(state);
  forward<double>(system_, parameters_, state.z.q, 0, w_.kinematics);
  SolveOptions solve;
  if (!state.turned)
    solve.start = start_values(coordinate_solutions(system_, parameters_, state.z.q,
                                                    Eigen::VectorXd::Zero(system_.nv), w_.kinematics));
  solve.nearest = !state.turned; // that is looked for from the drawn pose
  solve.details = details;
  solve.cancel = cancel_;
  if (analysis_)
    analysis_->update(varied_);
  else
    analysis_.emplace(varied_);
  Solution out = analysis_->solve(solve);
  if (state.turned && out.status == Status::converged) {
    constexpr double same = 1e-6;
    const Eigen::VectorXd found = configuration_of(problem(), out.coordinates);
    if (!out.turned || largest_size(scaled_difference(problem(), found, state.z.q)) > same) {
      out.status = Status::not_converged;
      out.message = "Solving from the drawn pose leads to another state that stands turned.";
    }
  }
  return out;
}

Eigen::VectorXd SteadyMap::inside(Eigen::VectorXd p) const {
  for (Eigen::Index i = 0; i < count(); ++i)
    for (const double end : {lower_[i], upper_[i]})
      if (std::abs(p[i] - end) < 1e-12 * range_[i]) p[i] = end;
  return p.cwiseMax(lower_).cwiseMin(upper_);
}

double SteadyMap::away(std::size_t wanted, double value, double goal) const {
  return away_from(system_, parameters_, wanted_[wanted], value, goal);
}

std::string SteadyMap::unit(std::size_t wanted) const {
  return unit_of(varied_, system_, wanted_[wanted]);
}

std::optional<double> SteadyMap::scale(std::size_t wanted) const {
  return scale_of(system_, parameters_, wanted_[wanted]);
}

} // namespace flyball
