// The equations of motion as sparse equations of the bodies (kkt/body_equations.hpp, with inertia for
// stiffness): for nets and loops of many bodies, where everything that moves has mass and no drive rides on
// what moves freely.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/sparse_step.hpp"
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
  // Whether more is singular than then, or something else has mass; of the last factor().
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
  bool all_singular_are_rows(const MotionPoint& point);
  // [M, J^T; J, 0] [x; lambda] = [force; closing], scaled.
  void solve(const Eigen::VectorXd& force, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
             Eigen::VectorXd& lambda);

  const MotionModel& model_;
  const System& system_; // released
  int n_;
  BodyEquations bodies_;
  SparseFactorization mass_;
  SparseStep step_;
  SparseConstraints constraints_;
  // Rows that others imply, at most: rounding may leave one of them a pivot, which does no harm.
  int redundant_ = 0;
  int expected_size_ = 0;
  std::vector<int> still_; // coordinates that nothing acts on

  Unknowns at_;
  Residual<double> residual_, loaded_; // without accelerations and multipliers, and with them
  Magnitudes magnitudes_;
  Kinematics<double> accelerated_;
  std::vector<LinkRates> carried_;
  Eigen::VectorXd zero_lambda_, bias_, force_, closing_, scaled_a_, scaled_lambda_, reduced_, unused_, all_a_;
  Eigen::VectorXd drive_forces_;
};

} // namespace flyball
