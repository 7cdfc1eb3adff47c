// The direct solution of a mechanism, as solving finds it, its reference in extended precision, and how far
// other states are from that: what compare() measures.
#pragma once

#include "engine/report/measures.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/search/turned_balance.hpp"
#include "engine/study/compare.hpp"

#include <atomic>
#include <optional>
#include <vector>

namespace flyball {

class DirectSolution {
 public:
  DirectSolution(const Mechanism& mechanism, const std::atomic<bool>* cancel);

  const System& system() const { return system_; }
  const Scaling& scaling() const { return scaling_; }

  // From the drawn pose to an answer that is known to exist and be stable, as Analysis::solve does.
  bool answer(Unknowns& z);
  int iterations() const { return turned_ ? turned_->iterations : steady_.found.iterations; }
  bool turned() const { return turned_.has_value(); }

  // q* by Newton's steps on the balance in extended precision, from an answer, until nothing moves.
  void settle_reference(const Unknowns& answer, Comparison& out);

  // How far along V (AngleTies) what turned by `angles` (by link, of the motion, `time` s from its beginning)
  // is from q*, but for whole turns of each: rad, or parts of the reach. Takes these angles for
  // measure_errors.
  double take_angles(const Eigen::VectorXd& angles, double time);

  // Whether q* leaves anything that errors are of: not where it may be turned or moved in every coordinate.
  bool determines_anything() const;

  // The largest part of a change (nv, scaled) that is no turn or move along what is arbitrary.
  double size_of(const Eigen::VectorXd& change) const;

  // The largest difference from q*, in radians or relative to the reach, of what is not arbitrary.
  double error_of(const Eigen::VectorXd& q) const;

  // Of the measures, from what they are at q*.
  std::vector<double> measure_errors(const Eigen::VectorXd& q);
  const Eigen::VectorXd& measured() const { return measured_; } // at q*

  // The state after so many plain iterations from the drawn pose, and whether more would change it.
  bool iterate(int count, Unknowns& z);

 private:
  Problem problem() const { return {system_, parameters_, scaling_, cancel_, system_.kkt_form}; }
  // By matrices as far as eigenvalues are found without being asked for.
  Problem classified() const;

  bool answer_turned(Unknowns& z);

  // What nothing resists at z is no error: of a link's rotation the turns about these axes, of others all.
  void take_neutral(const Unknowns& z);

  // By steps of the balance with the angles among its unknowns.
  void settle_turned_reference(Comparison& out);

  void tell_reference(const Eigen::VectorXd& correction, Comparison& out);

  const Mechanism& mechanism_;
  const std::atomic<bool>* cancel_;
  System system_;
  Parameters parameters_; // at the angles of a state that stands turned
  Parameters as_drawn_;
  std::optional<TurnedState> turned_;
  Scaling scaling_;
  Eigen::VectorXd drawn_;
  Workspace w_;
  SteadyState steady_;
  Stability stability_;
  std::vector<Eigen::MatrixXd> arbitrary_; // by link: orthonormal directions of its coordinates, by column
  Configuration<Extended> reference_;
  MeasureSet measures_;
  Eigen::VectorXd measured_;
};

} // namespace flyball
