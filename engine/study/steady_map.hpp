// A steady state as a function of several numbers of its mechanism: along its branch, with what is asked of
// it and the rates of both by the implicit function theorem.
//
// The state beside one that is known is predicted by its rates and corrected by Newton-Raphson. Where a fold
// or a crossing of branches lies between there is none: the inertia of the balance tells where there is a
// potential.
#pragma once

#include "engine/kkt/workspace.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/study/free_number.hpp"
#include "engine/study/wanted.hpp"

#include <optional>
#include <span>

namespace flyball {

// The steady state nearest to a start (as of SolveOptions), or where that is empty what a solve answers.
// Where there is none near it the answer if that stands turned against the drawn pose: such are near no
// start.
Solution steady_state_near(const Mechanism& mechanism,
                           const std::vector<std::pair<std::string, double>>& start,
                           const std::atomic<bool>* cancel);

class SteadyMap {
 public:
  struct State {
    Eigen::VectorXd p;      // the numbers, in their units
    Unknowns z;             // at the drawn phase
    Eigen::VectorXd values; // of what is asked for: rad, m or the measure's unit
    // Of one that stands turned against the drawn pose (phase_search.hpp): its angles, with `z`.
    std::optional<TurnedState> turned{};
  };

  // `wanted` as of find_wanted(). Throws SceneError as that does, for addresses that do not exist, for ranges
  // without an extent and for a number that is free twice.
  SteadyMap(const Mechanism& mechanism, std::span<const FreeNumber> free, std::vector<std::string> wanted,
            const std::atomic<bool>* cancel);
  SteadyMap(const SteadyMap&) = delete;
  SteadyMap& operator=(const SteadyMap&) = delete;

  // The steady state of the mechanism's own numbers, inside their ranges: from `start` (as of SolveOptions),
  // or where that is empty what a solve answers. Nothing where there is none: `first` says why.
  std::optional<State> begin(const std::vector<std::pair<std::string, double>>& start, Solution& first);

  // Where nothing resists some directions along which states go on, as the turning of a bob on a ball joint
  // about its own rod: states are followed across them from here on, and what differs along them has no
  // value. False where the state is not one of such a family, and of more than some hundred coordinates.
  bool follow_across(State& state);
  // Whether what is asked for differs along them.
  bool is_open(std::size_t wanted) const { return wanted < open_.size() && open_[wanted]; }

  // From here on, where extents of one branch are told, measures of angles, in rad, that jump from pi to -pi
  // go on beyond pi along the states, as coordinates do; and walks refuse steps that rates at both ends do
  // not lead across, as past two folds where a spring's force falls and rises again. Where branches cross
  // they end, too.
  void keep_to_branch() { keeps_to_branch_ = true; }
  // Whether a measure jumped otherwise on a way that was walked since.
  bool jumps(std::size_t wanted) const { return wanted < jumps_.size() && jumps_[wanted]; }

  // At a state that was found: how the coordinates go with the numbers, and rates() of what is asked for
  // ((wanted, numbers)), per unit of the numbers; not numbers in the rows of measures that have none. False
  // where the state is singular, or at an end of what mechanisms can be made of. By the balance's exact rates
  // in the numbers (sensitivity.hpp).
  bool find_rates(const State& state);
  const Eigen::MatrixXd& rates() const { return rates_; }
  // How far the state would go with a step of the numbers: the largest coordinate, in rad or reaches.
  double way(const Eigen::VectorXd& step) const;

  // From the state whose rates were found last. Nothing where no steady state follows from it there. Values
  // of measures that have none are not numbers.
  std::optional<State> step_to(const State& from, const Eigen::VectorXd& p);
  // The same by as many steps as it takes, in place: as far as steady states follow. Whether that is all the
  // way.
  bool walk_to(State& state, const Eigen::VectorXd& p);

  // All that a solve tells of a state.
  Solution solution(const State& state, bool details);

  double away(std::size_t wanted, double value, double goal) const;
  std::string unit(std::size_t wanted) const;
  // What differences are measured by: 1 rad, the mechanism's reach, of a measure nothing by itself.
  std::optional<double> scale(std::size_t wanted) const;

  // Moved into the ranges, and to an end from where only rounding keeps it away.
  Eigen::VectorXd inside(Eigen::VectorXd p) const;
  Eigen::Index count() const { return range_.size(); }
  const Eigen::VectorXd& range() const { return range_; } // to - from
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }

 private:
  Problem problem() const { return {system_, parameters_, scaling_, cancel_, system_.kkt_form}; }
  bool measures_wanted() const;
  // The numbers, and what a speed that is found is measured by, which is that in q.
  void set(const Eigen::VectorXd& p, const Eigen::VectorXd& q);
  // The same with the angles of a state.
  void set(const State& state);
  Problem dense() const { return {system_, parameters_, scaling_, cancel_}; }
  std::optional<State> begin_turned();
  std::optional<State> step_to_turned(const State& from, const Eigen::VectorXd& p);
  bool find_turned_rates(const State& state);
  void find_values(State& state);
  // The same of a state to which a step leads from the one whose rates were found last.
  void find_values(State& state, const State& from);
  bool correct(Unknowns& z);
  std::optional<State> step_along_branch(const State& from, const Eigen::VectorXd& p);
  bool goes_on(const State& from, const Eigen::MatrixXd& state_rates, const State& to) const;
  void look_for_jumps(const State& from, const Eigen::MatrixXd& before, const State& to);
  bool may_jump(std::size_t wanted, const State& from, const Eigen::VectorXd& rate_from, const State& to,
                const Eigen::VectorXd& rate_to) const;
  bool is_jump(std::size_t wanted, State from, State to);

  Mechanism varied_;
  std::optional<VariedNumbers> numbers_; // of it
  System system_;
  Parameters parameters_;
  Scaling scaling_;
  const std::atomic<bool>* cancel_;
  std::vector<std::string> addresses_;
  std::vector<Wanted> wanted_;
  Eigen::VectorXd lower_, upper_, range_, p_;
  MeasureSet measures_;
  Eigen::MatrixXd state_rates_, rates_;
  std::optional<Analysis> analysis_;  // of states that are told
  bool keeps_to_branch_ = false;      // see keep_to_branch()
  std::vector<bool> jumps_;           // see jumps()
  bool across_ = false;               // see follow_across()
  std::vector<bool> open_;            // what of `wanted_` has no value then
  int negative_ = 0;                  // eigenvalues of the balance, at the state with these rates,
  Eigen::VectorXd rated_p_, rated_q_; // which is this one, and the scale of its coordinates
  Eigen::VectorXd rated_scale_;
  Workspace w_;
};

} // namespace flyball
