// The equations of motion as sparse equations of the bodies (kkt/body_equations.hpp, with inertia for
// stiffness): for nets and loops of many bodies, where everything that moves has mass and no drive rides on
// what moves freely.
//
// Matrices of implicit steps leave out what velocities and accelerations beside those of the drives add to K
// and C: they are those of bodies that stand still in their drive's frame, as in every steady state.
// Newton's iteration needs no more (Hairer and Wanner, Solving Ordinary Differential Equations II, section
// IV.8); a fast motion, whose derivatives they are not, is followed in short steps anyway.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/motion_solver.hpp"
#include "engine/kkt/motion_products.hpp"
#include "engine/kkt/sparse_constraints.hpp"

namespace flyball {

class SparseMotion final : public MotionSolver {
 public:
  // Of a model with `sparse`.
  explicit SparseMotion(const MotionModel& model);

  // Tells redundant rows from directions without mass at a point whose kinematics are without accelerations.
  // False where there are such directions, which these equations cannot follow, unless nothing at all acts
  // along them: then they stand still.
  bool analyse(const MotionPoint& point);
  // Whether the rows that others imply, or what has mass, are others than they were then; of the last
  // factor().
  bool structure_changed() const;

  bool factor(const MotionPoint& point) override;
  bool accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) override;
  double drive_force(int drive) const override;
  std::string unsolved() const override;
  bool linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) override;
  bool factor_step(double gamma, const std::vector<Mat3>& turns) override;
  void solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) override;

  // The change of the velocity nearest to zero in kinetic energy that makes the loops' rows change by `rates`
  // less than they do (m/s, rad/s or 1/s) and, with `momenta` of the links about their origins, leaves no
  // momentum along any free coordinate. Of the last factor().
  void correct_velocity(const MotionPoint& point, const Eigen::VectorXd& rates,
                        const std::vector<Vec6>* momenta, Eigen::VectorXd& change);

  // The loops by themselves: the shortest scaled step that changes the scaled rows by `closing`.
  void factor_constraints(const MotionPoint& point);
  void close(const Eigen::VectorXd& closing, Eigen::VectorXd& step);

  const Eigen::VectorXd& phi() const { return residual_.phi; } // m, rad or 1; of the last accelerate()

 private:
  bool find_still(const MotionPoint& point);
  void take_in(const MotionPoint& point, const Eigen::VectorXd& lambda);
  // [M, J^T; J, 0] [x; lambda] = [force; closing], scaled; with the factors of M or those of a step.
  void solve(BodyEquations& equations, SparseFactorization& factors, const Eigen::VectorXd& force,
             const Eigen::VectorXd& closing, Eigen::VectorXd& x, Eigen::VectorXd& lambda);

  const MotionModel& model_;
  const System& system_; // released
  int n_;
  BodyEquations bodies_, step_bodies_;
  SparseFactorization mass_, step_;
  SparseConstraints constraints_;
  int expected_nullity_ = 0, expected_size_ = 0;
  std::vector<int> still_; // coordinates that nothing acts on

  Residual<double> residual_;
  Eigen::VectorXd none_, zero_lambda_, bias_, force_, closing_, scaled_a_, scaled_lambda_, reduced_, unused_;
  Eigen::VectorXd drive_forces_;
  // At the point of the last accelerate() with its accelerations, and of the last linearise().
  Kinematics<double> accelerated_, linearised_;
  std::vector<LinkRates> carried_;
  Residual<double> loaded_;
  Magnitudes magnitudes_;
  Eigen::VectorXd all_a_;
  Unknowns at_;
  MotionProducts products_;
  double gamma_ = 0;
  Eigen::VectorXd scaled_s_, product_;
};

} // namespace flyball
