// The equations of motion along a tree, in time proportional to its bodies: for mechanisms without loops,
// where every coordinate moves mass. Steps of implicit methods are eliminated along it, too, or, where
// springs or dampers act between two bodies, by sparse equations.
#pragma once

#include "engine/dynamics/articulated_bodies.hpp"
#include "engine/dynamics/body_wrenches.hpp"
#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/newton_elimination.hpp"
#include "engine/dynamics/sparse_step.hpp"

namespace flyball {

class TreeMotion final : public MotionSolver {
 public:
  // Of a model that goes along_tree().
  explicit TreeMotion(const MotionModel& model);

  // See ArticulatedBodies; of the last factor().
  bool carries_all() const { return bodies_.carry_all(); }

  bool factor(const MotionPoint& point) override;
  bool accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) override;
  double drive_force(int drive) const override { return drive_forces_[static_cast<std::size_t>(drive)]; }
  std::string unsolved() const override;
  bool linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) override;
  bool factor_step(double gamma, const std::vector<Mat3>& turns) override;
  void solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) override;

 private:
  const MotionModel& model_;
  ArticulatedBodies bodies_;
  std::optional<NewtonElimination> elimination_;
  std::optional<SparseStep> step_; // with springs or dampers between bodies
  std::vector<Vec6> wrenches_;
  Eigen::VectorXd force_; // of all coordinates
  std::vector<double> drive_forces_;
};

} // namespace flyball
