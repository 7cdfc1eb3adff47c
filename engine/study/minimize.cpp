#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/goal_state.hpp"
#include "engine/study/look_around.hpp"

#include <nlopt.h>

#include <chrono>
#include <exception>
#include <memory>

namespace flyball {
namespace {

using State = SteadyMap::State;

constexpr int most_evaluations = 1000;
constexpr double kept_within = 1e-11; // scaled: the goals
constexpr int most_ways_down = 20;    // from where a search ended

class Minimizer {
 public:
  Minimizer(const Mechanism& mechanism, std::span<const FreeNumber> free, const std::string& objective,
            std::span<const Goal> goals, const GoalOptions& options)
      : options_(options), free_(free), goals_(goals), objective_(objective),
        map_(mechanism, free, wanted(objective, goals), options.cancel) {}

  // From a state where the goals are reached.
  void run(const std::vector<std::pair<std::string, double>>& start, GoalAnswer& out) {
    std::optional<State> first = map_.begin(start, out.solution);
    if (!first) {
      out.status = out.solution.status;
      out.message = out.solution.message;
      return;
    }
    if (!first->values.allFinite())
      throw SceneError("minimize", "expected a value to start from; there is none at the steady state");
    now_ = std::move(*first);
    set_scales();
    if (!known_ || !map_.rates().allFinite()) {
      tell_state(map_, now_, free_, goals_, options_.details, out);
      out.reached = false;
      out.message =
          "At the steady state to begin with nothing has a rate: it is singular, or what is wanted has none.";
      return;
    }
    const double before = now_.values[objective_row()];
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
        nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(free_.size())), nlopt_destroy);
    nlopt_set_lower_bounds1(search.get(), 0);
    nlopt_set_upper_bounds1(search.get(), 1);
    nlopt_set_min_objective(search.get(), objective_at, this);
    for (std::size_t i = 0; i < goals_.size(); ++i)
      constraints_.push_back({this, static_cast<Eigen::Index>(i)});
    for (Constraint& each : constraints_)
      nlopt_add_equality_constraint(search.get(), constraint_at, &each, kept_within);
    // No tolerance of the objective: it may stand still at an end of a range while the goals are not yet
    // kept.
    nlopt_set_xtol_rel(search.get(), 1e-11);
    nlopt_set_maxeval(search.get(), most_evaluations);
    search_ = search.get();
    Eigen::VectorXd x = (now_.p - map_.lower()).cwiseQuotient(map_.range());
    bool exhausted = false;
    std::optional<State> best; // before a step down
    for (int ways = 0;; ++ways) {
      double least = 0;
      nlopt_optimize(search.get(), x.data(), &least); // what it says, its state and the goals tell better
      if (interrupted_) std::rethrow_exception(interrupted_);
      const bool lost = lost_ && nlopt_get_force_stop(search.get()) != 0;
      if (!lost) go_to(x);
      lost_ = lost_ || lost;
      out.iterations += nlopt_get_numevals(search.get());
      if (!now_.values.allFinite())
        throw SceneError(objective_, "expected a value all along the way; it has none there");
      exhausted = nlopt_get_numevals(search.get()) >= most_evaluations;
      if (best && !(goals_kept() && now_.values[objective_row()] < best->values[objective_row()])) {
        now_ = *best; // the way led nowhere
        lost_ = exhausted = flat_ = false;
        led_nowhere_ = true;
        map_.find_rates(now_);
        break;
      }
      if (lost_ || exhausted || !goals_kept()) break;
      best = now_;
      if (!step_down(x)) break;
      exhausted = ways == most_ways_down;
      if (exhausted) break;
    }
    tell_state(map_, now_, free_, goals_, options_.details, out);
    out.least = GoalAnswer::Reached{objective_, map_.unit(goals_.size()),
                                    now_.values[objective_row()] + 0., // no minus zero
                                    before + 0.};
    if (out.status != Status::converged) return;
    const bool kept = goals_kept();
    out.reached = kept && !exhausted && !lost_ && !stopped_;
    out.message = sentence(out, kept, exhausted);
  }

 private:
  struct Constraint {
    Minimizer* self;
    Eigen::Index goal;
  };

  static std::vector<std::string> wanted(const std::string& objective, std::span<const Goal> goals) {
    std::vector<std::string> out;
    for (const Goal& goal : goals)
      out.push_back(goal.wanted);
    out.push_back(objective);
    return out;
  }

  Eigen::Index objective_row() const { return static_cast<Eigen::Index>(goals_.size()); }

  Eigen::VectorXd unscaled(const Eigen::VectorXd& x) const {
    return map_.inside(map_.lower() + x.cwiseProduct(map_.range()));
  }

  void set_scales() {
    scales_.resize(now_.values.size());
    for (std::size_t i = 0; i <= goals_.size(); ++i) {
      const double size = std::abs(now_.values[static_cast<Eigen::Index>(i)]);
      scales_[static_cast<Eigen::Index>(i)] = map_.scale(i).value_or(size > 0 ? size : 1);
    }
    known_ = map_.find_rates(now_);
  }

  double residual(Eigen::Index goal, const State& state) const {
    return map_.away(static_cast<std::size_t>(goal), state.values[goal],
                     goals_[static_cast<std::size_t>(goal)].value) /
           scales_[goal];
  }

  bool goals_kept() const {
    for (std::size_t i = 0; i < goals_.size(); ++i)
      if (!(std::abs(residual(static_cast<Eigen::Index>(i), now_)) < 1e-8)) return false;
    return true;
  }

  // Moves now_ along its branch towards x, as far as there are steady states; whether it arrived.
  bool go_to(const Eigen::VectorXd& x) {
    lost_ = !map_.walk_to(now_, unscaled(x));
    known_ = map_.find_rates(now_);
    return !lost_;
  }

  // Of row i at x, scaled, with its slope where one is asked for. Where no steady state follows, a wall that
  // leads back.
  double at(unsigned n, const double* shares, double* slope, Eigen::Index row) {
    try {
      const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(shares, n);
      const bool arrived = go_to(x), goal = row < objective_row();
      if (!known_ || !map_.rates().allFinite() || !now_.values.allFinite()) { // nothing leads on from there
        lost_ = true;
        nlopt_force_stop(search_);
        if (slope) std::fill_n(slope, n, 0.);
        return 0;
      }
      double value = goal ? residual(row, now_) : now_.values[row] / scales_[row];
      Eigen::VectorXd gradient = map_.rates().row(row).transpose().cwiseProduct(map_.range()) / scales_[row];
      if (!arrived && !goal) {
        const Eigen::VectorXd beyond = (unscaled(x) - now_.p).cwiseQuotient(map_.range());
        const double steep = 10 * (1 + gradient.norm());
        value += steep * beyond.norm();
        gradient += steep * beyond.normalized();
      }
      if (slope) Eigen::Map<Eigen::VectorXd>(slope, n) = gradient;
      return value;
    } catch (...) { // not through the C of NLopt
      interrupted_ = std::current_exception();
      nlopt_force_stop(search_);
      return 0;
    }
  }

  // A state, whose rates the map's are if they are `known`.
  PlaceBeside scaled(const State& state, bool known) const {
    PlaceBeside out{
        state.values[objective_row()] / scales_[objective_row()], Eigen::VectorXd(objective_row()), {}};
    for (Eigen::Index i = 0; i < objective_row(); ++i)
      out.residuals[i] = residual(i, state);
    if (known && map_.rates().allFinite())
      out.slopes = scales_.cwiseInverse().asDiagonal() * map_.rates() * map_.range().asDiagonal();
    return out;
  }

  // From where the search ended: x and now_ are moved to where there is less beside. Whether they were.
  bool step_down(Eigen::VectorXd& x) {
    const State here = now_;
    const PlaceBeside place = scaled(here, known_);
    if (place.slopes.size() == 0) return false;
    const Surroundings around =
        look_around(x, place, [&](const Eigen::VectorXd& to) -> std::optional<PlaceBeside> {
          State there = here;
          if (!map_.find_rates(here) || !map_.walk_to(there, unscaled(to)) || !there.values.allFinite())
            return std::nullopt;
          return scaled(there, map_.find_rates(there));
        });
    flat_ = around.flat;
    stopped_ = around.slopes;
    if (!around.lower) return false;
    x = *around.lower;
    map_.find_rates(here);
    return go_to(x);
  }

  static double objective_at(unsigned n, const double* x, double* slope, void* self) {
    auto& minimizer = *static_cast<Minimizer*>(self);
    return minimizer.at(n, x, slope, minimizer.objective_row());
  }
  static double constraint_at(unsigned n, const double* x, double* slope, void* constraint) {
    const auto& each = *static_cast<Constraint*>(constraint);
    return each.self->at(n, x, slope, each.goal);
  }

  std::string sentence(const GoalAnswer& out, bool kept, bool exhausted) const {
    const GoalAnswer::Reached& least = *out.least;
    const std::string unit = least.unit.empty() ? "" : " " + least.unit;
    std::string text = least.wanted + " is " + rounded_text(least.value, 8) + unit + ", from " +
                       rounded_text(least.goal, 8) + unit;
    if (!kept)
      text += "; the goals are not kept";
    else if (exhausted)
      text += "; the search was not at its end";
    else if (lost_)
      text += "; beyond it no steady state follows";
    else if (flat_)
      text += ": beside it none of the numbers that may move changes it noticeably";
    else if (stopped_)
      text += "; the search stopped on the way to less: begin from other numbers";
    else if (led_nowhere_)
      text += ": nothing less was found nearby, and it need not be the least of all";
    else
      text += ": a minimum nearby, which need not be the least of all";
    return text + "." + closing_words(out);
  }

  const GoalOptions& options_;
  std::span<const FreeNumber> free_;
  std::span<const Goal> goals_;
  std::string objective_;
  SteadyMap map_;
  State now_;                // that was evaluated last
  bool known_ = false;       // its rates are the map's
  bool lost_ = false;        // it is not where it was asked for
  bool flat_ = false;        // nothing changes the objective there
  bool stopped_ = false;     // where it could be less along what keeps the goals
  bool led_nowhere_ = false; // a step down from where the search ended
  Eigen::VectorXd scales_;
  std::vector<Constraint> constraints_;
  nlopt_opt search_ = nullptr;
  std::exception_ptr interrupted_;
};

} // namespace

GoalAnswer minimize(const Mechanism& mechanism, std::span<const FreeNumber> free,
                    const std::string& objective, std::span<const Goal> goals, const GoalOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Interruptible scope(options.cancel);
  GoalAnswer out;
  try {
    // Where the goals are reached it begins.
    std::vector<std::pair<std::string, double>> start = options.start;
    Mechanism from = mechanism;
    if (!goals.empty()) {
      out = seek_goals(mechanism, free, goals, options);
      if (!out.reached) return out;
      std::vector<ParameterValue> values;
      for (const GoalAnswer::Number& number : out.numbers)
        values.push_back({number.address, number.value});
      set_parameters(from, values);
      start = start_values(out.solution.coordinates);
      out = {};
    }
    Minimizer minimizer(from, free, objective, goals, options);
    minimizer.run(start, out);
  } catch (const Interrupted&) {
    out.status = Status::not_converged;
    out.message = "Cancelled.";
  }
  out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

} // namespace flyball
