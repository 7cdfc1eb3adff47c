#include "engine/study/goals.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/least_change.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

using State = SteadyMap::State;

// All scaled: numbers by their ranges, goals as goals.hpp says.
constexpr int most_iterations = 200;
constexpr double goal_tolerance = 1e-12;  // a goal is reached
constexpr double number_tolerance = 1e-9; // a shorter step of the numbers is the last
constexpr int most_tries = 60;            // of a step, each shorter than the one before
constexpr double longest_step = 0.2;      // of a number in one step
constexpr double longest_way = 0.3;       // of the state in one step

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

  void seek(State now) {
    const Eigen::VectorXd origin = reference_.cwiseQuotient(map_.range()),
                          lower = map_.lower().cwiseQuotient(map_.range()) - origin,
                          upper = map_.upper().cwiseQuotient(map_.range()) - origin;
    Eigen::VectorXd left = away(now);
    double damping = 0;
    bool singular = false, stuck = false;
    for (; out_.iterations < most_iterations; ++out_.iterations) {
      interruption_point();
      if (!map_.find_rates(now) || !map_.rates().allFinite()) {
        singular = true;
        break;
      }
      const Eigen::MatrixXd slopes =
          scales_.cwiseInverse().asDiagonal() * map_.rates() * map_.range().asDiagonal();
      const double steepness = slopes.norm();
      const Eigen::VectorXd at = now.p.cwiseQuotient(map_.range()) - origin;
      std::optional<State> next;
      Eigen::VectorXd next_left;
      double taken = 0;
      for (int tries = 0; tries < most_tries; ++tries) {
        Eigen::VectorXd step = least_change(slopes, slopes * at - left, lower, upper, damping, at) - at;
        const double way = map_.way(step.cwiseProduct(map_.range()));
        step *= std::min({1., longest_step / std::max(longest_step, step.lpNorm<Eigen::Infinity>()),
                          longest_way / std::max(longest_way, way)});
        taken = step.lpNorm<Eigen::Infinity>();
        // At the goals, or at the nearest: nothing to be gained any more.
        const Eigen::VectorXd promised = slopes * step;
        if (!(taken > number_tolerance) &&
            (left.norm() <= goal_tolerance || (left + promised).norm() > (1 - 1e-6) * left.norm()))
          break;
        next = map_.step_to(now, map_.inside(now.p + step.cwiseProduct(map_.range())));
        if (next) next_left = away(*next);
        if (next && next_left.allFinite()) {
          // Where the goals do not go as their rates promise, the state has left its branch or is about to.
          const bool follows =
              (next_left - left - promised).norm() <= 0.5 * promised.norm() + 10 * goal_tolerance;
          // Nearer, or as near as curvature lets a step be that only shortens the way from the reference.
          if (follows &&
              (next_left.norm() <= (1 - 1e-3) * left.norm() || next_left.norm() <= goal_tolerance ||
               (next_left.norm() < 0.1 * taken && (at + step).norm() < at.norm())))
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
      if (left.norm() <= goal_tolerance && taken <= 1e-6) break;
    }
    out_.reached = left.lpNorm<Eigen::Infinity>() <= 100 * goal_tolerance; // rounding of measures
    tell_state(map_, now, free_, goals_, options_.details, out_);
    if (out_.status == Status::converged) out_.message = sentence(singular, stuck);
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
