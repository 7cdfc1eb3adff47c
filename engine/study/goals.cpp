#include "engine/study/goals.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/goal_state.hpp"
#include "engine/study/least_change.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

using State = SteadyMap::State;

// All scaled: numbers by their ranges, goals as goals.hpp says.
constexpr int most_iterations = 200;
constexpr double goal_tolerance = 1e-12;                // a goal is reached
constexpr double number_tolerance = 1e-9;               // a shorter step of the numbers is the last
constexpr int most_tries = 60;                          // of a step, each shorter than the one before
constexpr double longest_step = 0.2;                    // of a number in one step
constexpr double longest_way = 0.3;                     // of the state in one step
constexpr double kept_tolerance = 100 * goal_tolerance; // goals are reached, with the rounding of measures
constexpr double least_tolerance = 1e-7; // of the change that could still be taken back, the goals kept

std::vector<std::string> wanted_of(std::span<const Goal> goals) {
  if (goals.empty()) throw SceneError("goals", "expected one or more");
  std::vector<std::string> wanted;
  for (const Goal& goal : goals)
    wanted.push_back(goal.wanted);
  return wanted;
}

class GoalSeeker {
 public:
  GoalSeeker(const Mechanism& mechanism, std::span<const FreeNumber> free, std::span<const Goal> goals,
             const GoalOptions& options)
      : options_(options), free_(free), goals_(goals),
        map_(mechanism, free, wanted_of(goals), options.cancel) {}

  GoalAnswer run() {
    const auto begin = std::chrono::steady_clock::now();
    const Interruptible scope(options_.cancel);
    try {
      if (std::optional<State> first = map_.begin(options_.start, out_.solution)) {
        set_scales(*first);
        seek(std::move(*first));
      } else {
        out_.status = out_.solution.status;
        out_.message = out_.solution.message;
      }
    } catch (const Interrupted&) {
      out_.status = Status::not_converged;
      out_.message = "Cancelled.";
    }
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

 private:
  void set_scales(const State& first) {
    scales_.resize(first.values.size());
    for (std::size_t i = 0; i < goals_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double now = first.values[row];
      if (!std::isfinite(now))
        throw SceneError("measures." + goals_[i].wanted,
                         "expected a value to start from; it has none at the steady state");
      const double size = std::max(std::abs(now), std::abs(goals_[i].value));
      scales_[row] = goals_[i].scale > 0 ? goals_[i].scale : map_.scale(i).value_or(size > 0 ? size : 1);
    }
    reference_ = first.p;
    for (std::size_t i = 0; i < free_.size(); ++i)
      if (free_[i].reference) reference_[static_cast<Eigen::Index>(i)] = *free_[i].reference;
  }

  // What is left to the goals, scaled.
  Eigen::VectorXd away(const State& state) const {
    Eigen::VectorXd out(state.values.size());
    for (std::size_t i = 0; i < goals_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      out[row] = map_.away(i, state.values[row], goals_[i].value) / scales_[row];
    }
    return out;
  }

  // How far the numbers are from the reference, in parts of their ranges.
  Eigen::VectorXd change(const Eigen::VectorXd& p) const {
    return (p - reference_).cwiseQuotient(map_.range());
  }

  // Of the goals with the change, at the state whose rates were found last.
  Eigen::MatrixXd slopes() const {
    return scales_.cwiseInverse().asDiagonal() * map_.rates() * map_.range().asDiagonal();
  }

  bool find_slopes(const State& state) { return map_.find_rates(state) && map_.rates().allFinite(); }

  // The part of a step that is taken at once.
  double part_at_once(const Eigen::VectorXd& step) const {
    const double way = map_.way(step.cwiseProduct(map_.range()));
    return std::min({1., longest_step / std::max(longest_step, step.lpNorm<Eigen::Infinity>()),
                     longest_way / std::max(longest_way, way)});
  }

  std::optional<State> stepped(const State& from, const Eigen::VectorXd& step) {
    return map_.step_to(from, map_.inside(from.p + step.cwiseProduct(map_.range())));
  }

  void seek(State now) {
    const Eigen::VectorXd lower = change(map_.lower()), upper = change(map_.upper());
    Eigen::VectorXd left = away(now);
    double damping = 0;
    bool singular = false, stuck = false;
    for (; out_.iterations < most_iterations; ++out_.iterations) {
      interruption_point();
      if (left.norm() <= goal_tolerance) break;
      if (!find_slopes(now)) {
        singular = true;
        break;
      }
      const Eigen::MatrixXd slope = slopes();
      const double steepness = slope.norm();
      const Eigen::VectorXd at = change(now.p);
      std::optional<State> next;
      Eigen::VectorXd next_left;
      double taken = 0;
      for (int tries = 0; tries < most_tries; ++tries) {
        Eigen::VectorXd step = least_change(slope, slope * at - left, lower, upper, damping, at) - at;
        step *= part_at_once(step);
        taken = step.lpNorm<Eigen::Infinity>();
        // At the nearest: nothing to be gained any more.
        const Eigen::VectorXd promised = slope * step;
        if (!(taken > number_tolerance) && (left + promised).norm() > (1 - 1e-6) * left.norm()) break;
        next = stepped(now, step);
        if (next) next_left = away(*next);
        if (next && next_left.allFinite()) {
          // Where the goals do not go as their rates promise, the state has left its branch or is about to.
          const bool follows =
              (next_left - left - promised).norm() <= 0.5 * promised.norm() + 10 * goal_tolerance;
          if (follows && (next_left.norm() <= (1 - 1e-3) * left.norm() || next_left.norm() <= goal_tolerance))
            break;
        }
        next.reset();
        damping = std::max({10 * damping, 1e-3 * steepness, 1e-12});
        if (damping > 1e9 * std::max(steepness, 1e-300)) break;
      }
      if (!next) {
        stuck = taken > number_tolerance;
        break;
      }
      damping = damping > 1e-9 * steepness ? damping / 10 : 0;
      now = std::move(*next);
      left = std::move(next_left);
    }
    out_.reached = left.lpNorm<Eigen::Infinity>() <= kept_tolerance;
    if (out_.reached) shorten(now);
    tell_state(map_, now, free_, goals_, options_.details, out_);
    if (out_.status == Status::converged) out_.message = sentence(singular, stuck);
  }

  // Along the states that keep the goals to where the change is least. Half its square falls there by the
  // square of d, the way to the least change that the slopes promise, and d has no slope of the goals. Steps
  // of d as long as the last one tells (Barzilai and Borwein, Two-point step size gradient methods, 1988),
  // and back to the goals from where they lead; ends where d is nothing, or where no state follows.
  void shorten(State& now) {
    const Eigen::VectorXd lower = change(map_.lower()), upper = change(map_.upper());
    Eigen::VectorXd last_d, last_step;
    for (; out_.iterations < most_iterations; ++out_.iterations) {
      interruption_point();
      if (!find_slopes(now)) return;
      const Eigen::VectorXd at = change(now.p);
      const Eigen::MatrixXd slope = slopes();
      const Eigen::VectorXd d = least_change(slope, slope * at, lower, upper, 0, at) - at;
      if (!(d.lpNorm<Eigen::Infinity>() > least_tolerance)) return;
      double length = 1;
      if (last_d.size() > 0)
        if (const double bend = last_step.dot(last_d - d); bend > 0)
          length = std::clamp(last_step.squaredNorm() / bend, 0.1, 10.);
      length *= part_at_once(length * d);
      std::optional<State> next;
      for (; length > least_tolerance; length /= 2) {
        next = stepped(now, length * d);
        if (next && back_to_goals(*next) &&
            change(next->p).squaredNorm() <= at.squaredNorm() - 1e-3 * length * d.squaredNorm())
          break;
        next.reset();
        if (!find_slopes(now)) return;
      }
      if (!next) return;
      last_d = d;
      last_step = change(next->p) - at;
      now = std::move(*next);
    }
  }

  // By the shortest steps, to where the goals are kept; whether they are.
  bool back_to_goals(State& state) {
    constexpr int most = 12;
    for (int i = 0;; ++i) {
      const Eigen::VectorXd left = away(state);
      if (!left.allFinite()) return false;
      if (left.norm() <= goal_tolerance) return true;
      const bool kept = left.lpNorm<Eigen::Infinity>() <= kept_tolerance;
      if (i == most || !find_slopes(state)) return kept;
      const Eigen::VectorXd at = change(state.p),
                            step =
                                least_change(slopes(), -left, change(map_.lower()) - at,
                                             change(map_.upper()) - at, 0, Eigen::VectorXd::Zero(at.size()));
      std::optional<State> next = stepped(state, part_at_once(step) * step);
      if (!next || !(away(*next).norm() < left.norm())) return kept;
      state = std::move(*next);
    }
  }

  std::string sentence(bool singular, bool stuck) const {
    std::string out;
    if (out_.reached) {
      out = goals_.size() == 1 ? "Reached." : "All goals are reached.";
    } else {
      out = "The nearest that can be reached: ";
      bool first = true;
      for (const GoalAnswer::Reached& goal : out_.goals) {
        const std::string unit = goal.unit.empty() ? "" : " " + goal.unit;
        out += (first ? "" : ", ") + goal.wanted + " = " + rounded_text(goal.value, 8) + unit + " for " +
               rounded_text(goal.goal, 8) + unit;
        first = false;
      }
      out += ".";
      const bool limited =
          std::ranges::any_of(out_.numbers, [](const GoalAnswer::Number& number) { return number.at_limit; });
      if (singular)
        out += " Nothing leads on from there: the steady state is singular, as at a fold or where branches "
               "cross, or what is wanted has no rate.";
      if (stuck && !singular && !limited)
        out += " Beyond it no steady state was found that follows from this one.";
    }
    return out + closing_words(out_);
  }

  const GoalOptions& options_;
  std::span<const FreeNumber> free_;
  std::span<const Goal> goals_;
  SteadyMap map_;
  Eigen::VectorXd scales_, reference_;
  GoalAnswer out_;
};

} // namespace

std::string closing_words(const GoalAnswer& answer) {
  std::vector<std::string_view> names;
  for (const GoalAnswer::Number& number : answer.numbers)
    if (number.at_limit && (!answer.reached || answer.least)) names.push_back(number.address);
  std::string words;
  if (!names.empty())
    words = std::string(names.size() == 1 ? " At the end of its range: " : " At the ends of their ranges: ") +
            word_list(names, "and") + ".";
  return words + (answer.solution.stable == false ? " The state is unstable." : "");
}

void tell_state(SteadyMap& map, const SteadyMap::State& state, std::span<const FreeNumber> free,
                std::span<const Goal> goals, bool details, GoalAnswer& out) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double value = state.p[static_cast<Eigen::Index>(i)];
    out.numbers.push_back({free[i].address, value, value == free[i].from || value == free[i].to});
  }
  for (std::size_t i = 0; i < goals.size(); ++i)
    out.goals.push_back(
        {goals[i].wanted, map.unit(i), state.values[static_cast<Eigen::Index>(i)], goals[i].value});
  out.solution = map.solution(state, details);
  out.status = out.solution.status;
  if (out.status == Status::converged) return;
  out.reached = false;
  out.message = out.solution.message;
}

GoalAnswer seek_goals(const Mechanism& mechanism, std::span<const FreeNumber> free,
                      std::span<const Goal> goals, const GoalOptions& options) {
  return GoalSeeker(mechanism, free, goals, options).run();
}

} // namespace flyball
