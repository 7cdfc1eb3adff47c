// The matrix of implicit steps (motion_solver.hpp) as sparse equations of the bodies.
//
// It leaves out what velocities and accelerations beside those of the drives add to K and C: they are those
// of bodies that stand still in their drive's frame, as in every steady state. Newton's iteration needs no
// more (Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.8); a fast motion, whose
// derivatives they are not, is followed in short steps anyway.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/motion_solver.hpp"
#include "engine/kkt/body_equations.hpp"
#include "engine/kkt/motion_products.hpp"
#include "engine/linear/sparse_factorization.hpp"

namespace flyball {

class SparseStep {
 public:
  // Of a model whose drives ride on nothing that moves freely.
  explicit SparseStep(const MotionModel& model);

  // Takes in K and C at a point whose kinematics have its accelerations. False where they are not finite.
  bool linearise(const MotionPoint& point, const Eigen::VectorXd& lambda);
  // Whether nothing acts along these coordinates at a point, and which directions have neither mass,
  // stiffness, damping nor constraint is as given, by unknown of BodyEquations.
  bool nothing_acts(const MotionPoint& point, const std::vector<int>& coordinates,
                    const std::vector<bool>& unconstrained);

  // The largest entry of M x + J^T lambda - force where K was taken in, scaled.
  double imbalance(const Eigen::VectorXd& x, const Eigen::VectorXd& lambda, const Eigen::VectorXd& force);

  void factor(double gamma);
  int nullity() const { return factors_.nullity(); }  // redundant rows as a rule
  int size() const { return bodies_.pattern().size; } // of the last factor()
  // ds, in the place of b_s; b_q as a tangent step.
  void solve(const Eigen::VectorXd& b_q, Eigen::VectorXd& s);

 private:
  void take_in(const MotionPoint& point, const Eigen::VectorXd& lambda);
  void assemble(double velocity, double stiffness);

  const MotionModel& model_;
  BodyEquations bodies_;
  SparseFactorization factors_;
  MotionProducts products_;
  double gamma_ = 0;
  // At the point taken in.
  Unknowns at_;
  Kinematics<double> kinematics_;
  Residual<double> residual_;
  Magnitudes magnitudes_;
  Eigen::VectorXd none_, scaled_, product_, force_, reduced_, change_;
};

} // namespace flyball
