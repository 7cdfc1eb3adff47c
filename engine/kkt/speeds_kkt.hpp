// The KKT matrix of a tree that torques drive: the speeds w that are found (drive_torque.hpp) are a border of
// the matrix at given speeds, whose factors are those of the tree,
//
//     [ K    b ] [x]   [g]        b = dF_q/dw, a column of the velocity matrix D
//     [ r^T  d ] [s] = [h]        r^T x: by one product K x, of the row that the shaft's angle would have
//
// s = (d - r^T K^-1 b)^-1 (h - r^T K^-1 g), x = K^-1 g - K^-1 b s. Each speed costs one more solution when it
// is factored, and each solution one product: in proportion to the bodies, as at given speeds. Of one shaft
// along gravity that turns alone no product: what turning it takes is nothing wherever its parts stand, and
// of r the law's part is left.
#pragma once

#include "engine/kkt/motion_products.hpp"
#include "engine/kkt/reduced_hessian.hpp"
#include "engine/kkt/tree_kkt.hpp"
#include "engine/system/drive_torque.hpp"

namespace flyball {

class SpeedsKkt final : public KktSystem {
 public:
  void linearize(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) override;
  void factor(double shift = 0) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  double metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  const std::vector<NullDirection>& null_directions() override { return directions_; }
  void direction_of(const NullDirection& direction, Eigen::VectorXd& x) override;

  // Whether the state is a strict minimum of the amended potential at its speeds, and the torques depend on
  // these alone and fall as they grow: then it is stable (stability.cpp has the proof). Of a balanced state,
  // factored without a shift.
  bool keeps_minimum() const;

  // Whether neither the tree at given speeds nor the speeds' Schur complement, as factored, has a direction
  // of negative stiffness.
  bool is_definite() const;

  TreeKkt& at_given_speeds() { return tree_; }

 private:
  void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                Eigen::VectorXd& lambda) override;
  // r^T x of each speed, x without speeds.
  void rows_times(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  void find_inertia(); // where it was not asked for yet
  double with_speeds(const Eigen::VectorXd& x, double square, Eigen::VectorXd& product) const;

  bool laws_alone_ = false; // make up r
  TreeKkt tree_;            // with the shafts held
  MotionProducts products_;
  std::vector<int> speeds_;                // their places in q_R
  std::vector<DriveTorqueEntry> by_value_; // of the laws, with coordinates; zero: with their rates
  Eigen::MatrixXd columns_;                // b by speed, (nv, speeds), without the speeds' own rows
  Eigen::MatrixXd resists_;                // d, (speeds, speeds)
  double time_ = 1;                        // what a speed gains counts by (speed_time.hpp), s
  Eigen::VectorXd inertia_;                // of each shaft, scaled, times that; empty: not asked for
  Eigen::MatrixXd response_;               // K^-1 b
  Eigen::MatrixXd schur_complement_;       // d - r^T K^-1 b
  ReducedHessian border_;                  // that, factored
  Eigen::VectorXd work_, product_, answer_, rest_;
  std::vector<NullDirection> directions_;
};

} // namespace flyball
