// The linear algebra of the balance at one state, whatever the size of the mechanism: the KKT matrix
//   [K + shift W, J^T; J, 0],
// K the stiffness (where there is a potential the Hessian of its Lagrangian), J the constraints' Jacobian, W
// a metric: factored, solved with, and asked for its inertia; and the constraints by themselves. All in
// scaled units (see Scaling).
//
// The metric is the bodies' inertias in the main, so that a step's length is that of the motion it makes and
// not of the angles it takes.
//
// Three forms: dense_kkt.hpp for few coordinates, tree_kkt.hpp along trees, sparse_kkt.hpp for nets and
// loops.
#pragma once

#include "engine/kkt/evaluation.hpp"
#include "engine/kkt/problem.hpp"

#include <utility>
#include <vector>

namespace flyball {

class KktSystem {
 public:
  // A direction without stiffness but for rounding: coordinates and their shares before the rest follows.
  using NullDirection = std::vector<std::pair<int, double>>;

  static constexpr double zero = 1e-11;     // of the stiffness that a coordinate carries
  static constexpr double rounding = 1e-15; // of the forces behind it
  static constexpr double own_share = 1e-6; // of the metric: what coordinates have beside the bodies

  virtual ~KktSystem() = default;

  // Takes in a state: `evaluation` at z, whose wrenches of the links are used, not its sums with multipliers.
  // It must stay there until the first factor() with a shift or metric().
  virtual void linearize(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) = 0;

  // The same without what compression takes off the stiffness of springs and loops: still a model of how the
  // balance changes, but one whose steps are downhill far from a minimum, too (projected Newton; Teran,
  // Sifakis, Irving, Fedkiw, Robust quasistatic finite elements, 2005). False where that changes nothing.
  virtual bool linearize_convex(const Problem&, const Unknowns&, const Evaluation&) { return false; }

  // Factors K + shift W on the constraints (shift in 1/s^2).
  virtual void factor(double shift = 0) = 0;

  // Solves [K + shift W, J^T; J, 0] [x; lambda] = [rhs; closing]. Null directions and redundant constraints
  // get no component.
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
  virtual bool limit_turns(double, Eigen::VectorXd&) { return false; }

  // W x, and x^T W x.
  virtual double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) = 0;
  // The same of what solve() has just given.
  virtual double metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
    return metric(x, product);
  }

  // The inertia of the last factor(): where there is a potential, the negative eigenvalues of K + shift W on
  // what the constraints leave free (Sylvester); those that are zero but for rounding.
  int negative_count() const { return negative_; }
  int null_count() const { return null_; }
  bool positive_definite() const { return negative_ == 0 && null_ == 0; }
  bool singular() const { return null_ > 0; }
  // By eigenvalues. Else by the signs of pivots, and rounding makes some of many null directions a little
  // stiff.
  virtual bool exact_inertia() const { return false; }
  // Whether it is right at this evaluated state: a redundant row that passes for an independent one counts as
  // stiffness. Factors the constraints to find out.
  virtual bool inertia_is_certain(const Problem&, const Evaluation&) { return true; }
  bool known() const { return known_; } // else it could not be factored, and counts as zero
  double shift() const { return shift_; }
  double mass() const { return mass_; } // kg, of what moves

  // null_count() of them.
  virtual const std::vector<NullDirection>& null_directions() = 0;
  int force_free_count() const { return force_free_; } // the first of these: what feels nothing at all
  // One of them with all that follows it.
  virtual void direction_of(const NullDirection& direction, Eigen::VectorXd& x) = 0;

  // A factorization costs several solutions: one more step with old factors is worth it.
  virtual bool factors_cost_more() const { return false; }

  // The constraints alone, at an evaluated state. Trees have none.
  virtual void factor_constraints(const Problem&, const Evaluation&) {}
  // The same where linearize() was called at this state, which may have done it.
  virtual void complete_constraints(const Problem&, const Evaluation&) {}
  // Of constraints so factored: how many do not follow from others.
  virtual int independent_rows(const Problem&, const Evaluation&) { return 0; }
  // lambda for which J^T lambda comes nearest to `force`, redundant rows as it happens or of least norm.
  virtual void balance(const Eigen::VectorXd&, Eigen::VectorXd& lambda) { lambda.setZero(rows_); }
  virtual void balance_with_least_norm(const Eigen::VectorXd& force, Eigen::VectorXd& lambda) {
    balance(force, lambda);
  }
  // The shortest x with J x = closing on the independent rows.
  virtual void close(const Eigen::VectorXd&, Eigen::VectorXd& x) { x.setZero(size_); }
  // What the constraints leave of a force: the acceleration it causes times a mass, that of the whole
  // mechanism at its reach where the metric is not that of the coordinates.
  virtual void project(const Eigen::VectorXd& force, Eigen::VectorXd& left) { left = force; }

 protected:
  static constexpr double enough_of_answers = 1e-11, enough_of_steps = 1e-8;

  // solve(), to `enough` of the terms of each equation where elimination alone leaves more.
  virtual void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                        Eigen::VectorXd& x, Eigen::VectorXd& lambda) = 0;

  int negative_ = 0, null_ = 0, force_free_ = 0, rows_ = 0, size_ = 0;
  bool known_ = true;
  double mass_ = 0, shift_ = 0;

 private:
  Eigen::VectorXd none_, multipliers_;
};

} // namespace flyball
