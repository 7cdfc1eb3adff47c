// Ways along places of joints with friction (standing_joints.hpp), at each of which all hold within their
// limits: up to where something that is told grows no more.
#pragma once

#include "engine/study/standing_joints.hpp"
#include "engine/study/steady_map.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

class PlacedWays {
 public:
  // `outputs`: what is told, by names as of find_wanted(), and of these `turning` as of freely_turning();
  // `reach` in m.
  PlacedWays(const StandingJoints& standing, const std::vector<std::string>& outputs,
             const std::vector<std::string>& turning, double reach, const std::atomic<bool>* cancel);

  // `left`: undecided, as another coordinate went too far or there were too many steps.
  enum class End { extremum, round, far, left, lost };

  // False where the state is singular with the joints standing, too.
  bool begin(const Solution& solution);

  bool is_coordinate(Eigen::Index output) const {
    return map_.scale(static_cast<std::size_t>(output)).has_value();
  }
  bool jumps(Eigen::Index output) const { return map_.jumps(static_cast<std::size_t>(output)); }
  std::string unit(Eigen::Index output) const { return map_.unit(static_cast<std::size_t>(output)); }
  bool has_rates(Eigen::Index output) const;
  // What is told of the shares follows the outputs.
  Eigen::Index objectives() const { return places_.front().state.values.size(); }

  // At the first place; the best at any, and where that is.
  double value(Eigen::Index output) const { return places_.front().state.values[output]; }
  double best(Eigen::Index output, double sense) const;
  std::size_t best_place(Eigen::Index output, double sense) const;
  std::size_t last_place() const { return places_.size() - 1; }

  // Whether the state there is stable as friction gives just that; nothing where that is not known.
  std::optional<bool> stable_at(const Mechanism& mechanism, std::size_t place);

  // How the last place differs from another: `same` within `near` (rad, reaches or shares).
  enum class Beside { elsewhere, same, turned };
  Beside compare_last(std::size_t other, double near) const;
  // Whether an output is another at the last place than at this one.
  bool changes_to_last(std::size_t other, Eigen::Index output) const;

  // From a place up to where the output, times `sense`, grows no more: to the last digits, or about, which
  // takes a tenth of the steps but may miss that something comes round.
  enum class Care { whole, rough };
  End climb(Eigen::Index output, double sense, std::size_t from, Care care = Care::whole);

 private:
  struct Place {
    SteadyMap::State state;
    Eigen::MatrixXd rates; // of the outputs, then of the shares that measures tell, with the numbers
  };

  bool is_length(Eigen::Index j) const;
  bool is_told(Eigen::Index j) const {
    return !standing_.joints[static_cast<std::size_t>(j)].measure.empty();
  }
  double scale_of(Eigen::Index output) const { return unit(output) == "rad" ? 1 : reach_; }
  double largest_part(const Eigen::VectorXd& step) const;
  Eigen::VectorXd shares(const Place& at) const;
  Eigen::MatrixXd share_rates(const Place& at) const;
  Eigen::VectorXd best_step(const Place& at, const Eigen::VectorXd& gradient, double step, double most) const;
  std::optional<Place> go(const Place& from, const Eigen::VectorXd& p, Eigen::Index output, double sense,
                          double mark);
  std::optional<Eigen::VectorXd> way_back(const Place& at, const Eigen::VectorXd& share,
                                          const Eigen::VectorXd& rate, double past) const;
  bool slips_between(const Place& from, const Place& to) const;
  bool comes_back(const Place& before, const Place& now) const;
  bool went_far(Eigen::Index output, const Place& begin, const Place& now) const;
  bool went_far(const Place& begin, const Place& now) const;

  const StandingJoints& standing_;
  Eigen::Index outputs_;
  double reach_;
  const std::atomic<bool>* cancel_;
  SteadyMap map_;
  std::vector<bool> turns_freely_; // the outputs
  Eigen::VectorXd radius_;         // of the numbers: a radian, the reach, all of a share
  std::vector<Place> places_;
  bool lost_ = false; // the last step: no state followed
};

} // namespace flyball
