// Solves the linearised balance by elimination, at a cost that grows with the bodies and not with the square
// of their coordinates: along the tree, or as the sparse equations of all bodies and loops. All in scaled
// units.
//
// A multiple of a metric can be added to the stiffness: the bodies' inertias in the main, so that a step's
// length is that of the motion it makes and not of the angles it takes.
#pragma once

#include "engine/kkt/problem.hpp"

#include <utility>
#include <vector>

namespace flyball {

class Eliminator {
 public:
  // A direction without stiffness but for rounding: coordinates and their shares before the rest gives way.
  using Flat = std::vector<std::pair<int, double>>;

  static constexpr double zero = 1e-11;     // of the stiffness that a coordinate carries
  static constexpr double rounding = 1e-15; // of the forces behind it
  static constexpr double own_share = 1e-6; // of the metric: what coordinates have beside the bodies

  virtual ~Eliminator() = default;

  // Takes in a state. Kinematics, residual and magnitudes must be at z; the residual's wrenches of the links
  // are used, not its sums with multipliers.
  virtual void linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                         const Residual<double>& residual, const Magnitudes& magnitudes) = 0;

  // The same without what compression takes off the stiffness of springs and loops: still a model of how the
  // balance changes, but one whose steps are downhill far from a minimum, too (projected Newton; Teran,
  // Sifakis, Irving, Fedkiw, Robust quasistatic finite elements, 2005). False where that changes nothing.
  virtual bool linearize_convex(const Problem&, const Unknowns&, const Kinematics<double>&,
                                const Residual<double>&, const Magnitudes&) {
    return false;
  }

  // Eliminates K + shift W (shift in 1/s^2).
  virtual void factor(double shift = 0) = 0;

  // Solves [K + shift W, J^T; J, 0] [x; lambda] = [rhs; closing], J the constraints' Jacobian. Directions
  // without stiffness and redundant constraints get no component.
  void solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
             Eigen::VectorXd& lambda) {
    solve_to(enough_of_answers, rhs, closing, x, lambda);
  }
  // Of steps that leave the loops closed; with fewer digits, since the next step corrects them.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
    none_.setZero(rows_);
    solve_to(enough_of_steps, rhs, none_, x, multipliers_);
  }
  const Eigen::VectorXd& multipliers() const { return multipliers_; } // that came with the last of these

  // Shortens what solve() has just given so that no body turns further than `most` (rad) altogether; what
  // hangs on it follows as solved for. False where none does, or nothing is known of it.
  virtual bool hold_turns(double, Eigen::VectorXd&) { return false; }

  // W x, and x^T W x.
  virtual double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) = 0;

  // The same of what solve() has just given.
  virtual double metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
    return metric(x, product);
  }

  // A direction without stiffness with all that follows it.
  virtual void direction_of(const Flat& flat, Eigen::VectorXd& x) = 0;

  // Of the last factor(), where there is a potential: negative eigenvalues of K + shift W on what the
  // constraints leave free (Sylvester).
  int negative_count() const { return negative_; }
  const std::vector<Flat>& flat() const { return flat_; }
  std::size_t loose() const { return loose_; } // of flat(), the first: what feels nothing at all
  bool positive_definite() const { return negative_ == 0 && flat_.empty(); }
  double shift() const { return shift_; } // of the last factor()
  double mass() const { return mass_; }   // kg, of what moves

 protected:
  static constexpr double enough_of_answers = 1e-11, enough_of_steps = 1e-8;

  // solve(), to `enough` of the terms of each equation where elimination alone leaves more.
  virtual void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                        Eigen::VectorXd& x, Eigen::VectorXd& lambda) = 0;

  std::vector<Flat> flat_;
  std::size_t loose_ = 0;
  int negative_ = 0, rows_ = 0;
  double mass_ = 0, shift_ = 0;

 private:
  Eigen::VectorXd none_, multipliers_;
};

} // namespace flyball
