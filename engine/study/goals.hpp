// Several numbers of a mechanism moved so that its steady state goes where it is wanted: sliders in reverse.
//
// From the steady state at hand and along its branch. With J the rates of what is wanted with the free
// numbers along the steady states (the implicit function theorem), the numbers go where J promises the goals
// by the least change from where they were, each in parts of its range: Gauss-Newton within bounds, damped as
// of Levenberg and Marquardt where the goals do not follow (Nocedal and Wright, Numerical Optimization, 2006,
// chapter 10). From where they are reached the numbers go on along the states that keep them to where their
// change from where they were is least: nearby, which need not be the least of all. The state is predicted by
// its rates and corrected by Newton-Raphson. What cannot be reached ends at the nearest that can: the least
// sum of squares, angles in rad, lengths in parts of the mechanism's reach, measures in parts of the larger
// of wanted and first value.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/free_number.hpp"

#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct Goal {
  std::string wanted; // as of find_wanted()
  double value = 0; // rad or m, else in the measure's unit; of an angle without spring and stop modulo turns
  double scale = 0; // in the same: what counts as much as one of the others; 0: as above
  bool operator==(const Goal&) const = default;
};

struct GoalOptions {
  std::vector<std::pair<std::string, double>> start{}; // the steady state to begin at, as of SolveOptions
  bool details = true;                                 // of the solution, as of SolveOptions
  const std::atomic<bool>* cancel = nullptr;
};

struct GoalAnswer {
  // converged: a steady state was found, whether or not it is where it is wanted; else `message` says why
  // not.
  Status status = Status::not_converged;
  bool reached = false;
  std::string message; // a sentence or two
  struct Number {
    std::string address;
    double value = 0;      // in its unit
    bool at_limit = false; // stands at an end of its range
  };
  std::vector<Number> numbers; // as the free ones
  struct Reached {
    std::string wanted, unit;
    double value = 0, goal = 0;
  };
  std::vector<Reached> goals;
  std::optional<Reached> least; // what was minimised; `goal` is its value where that began
  Solution solution;            // there
  int iterations = 0;           // of the numbers
  double run_time_s = 0;
};

// From the mechanism's own numbers. Throws SceneError as SteadyMap does.
GoalAnswer seek_goals(const Mechanism& mechanism, std::span<const FreeNumber> free,
                      std::span<const Goal> goals, const GoalOptions& options = {});

// Those numbers at which `objective`, as of find_wanted(), is least within the ranges, with the goals
// kept where there are any: a local minimum, by sequential quadratic programming (SLSQP: D. Kraft, ACM TOMS
// 20, 1994; as NLopt has it) from the mechanism's own numbers, or from where the goals are reached first.
GoalAnswer minimize(const Mechanism& mechanism, std::span<const FreeNumber> free,
                    const std::string& objective, std::span<const Goal> goals,
                    const GoalOptions& options = {});

} // namespace flyball
