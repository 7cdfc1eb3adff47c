// The equations of motion by dense matrices of all free coordinates and independent rows: for mechanisms of
// any kind, also with bodies without mass that forces act on, of some hundred coordinates at most.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/motion_solver.hpp"
#include "engine/dynamics/saddle_point.hpp"

namespace flyball {

class DenseMotion final : public MotionSolver {
 public:
  // What is solved for: independent rows of Phi, and the free coordinates that carry the mass. Both
  // ascending; they may change from one factor() to the next.
  DenseMotion(const MotionModel& model, const std::vector<int>& rows, const std::vector<int>& regular);

  bool factor(const MotionPoint& point) override;
  bool accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) override;
  double drive_force(int drive) const override;
  std::string unsolved() const override;
  bool linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) override;
  bool factor_step(double gamma, const std::vector<Mat3>& turns) override;
  void solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) override;

  // The parts of these, for what moves without momentum and for loops that are put back together.
  void evaluate_mass(const MotionPoint& point);
  bool factor_constraints(const MotionPoint& point);
  void evaluate_forces(const MotionPoint& point);
  // M a + Phi_q^T lambda = -force on the regular coordinates, Phi_q a = -bias.
  bool solve(const Eigen::VectorXd& force, const Eigen::VectorXd& bias, Eigen::VectorXd& a,
             Eigen::VectorXd& lambda);
  SaddlePoint& saddle() { return saddle_; }
  const SaddlePoint& saddle() const { return saddle_; }
  const MassMatrix& mass() const { return mass_; }
  const Eigen::MatrixXd& gradient() const { return gradient_; } // (rows, all coordinates), rows scaled
  const Eigen::VectorXd& force() const { return force_; }       // f without accelerations, of all coordinates
  const Eigen::VectorXd& phi() const { return residual_.phi; }  // as that left it

 private:
  const MotionModel& model_;
  const System& system_; // released
  const std::vector<int>&rows_, &regular_;
  int n_;

  MassMatrix mass_;
  Eigen::MatrixXd gradient_, scaled_mass_, scaled_gradient_;
  SaddlePoint saddle_;
  Residual<double> residual_, moving_residual_;
  Eigen::VectorXd zero_lambda_, force_, bias_, a_, target_force_, target_rows_, scaled_a_, scaled_lambda_;

  Linearization linearization_;
  Eigen::MatrixXd with_q_, with_s_; // derivatives of the acceleration, (n, n)
  double gamma_ = 0;
  Lu step_;
};

} // namespace flyball
