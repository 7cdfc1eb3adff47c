// Storage that solves reuse, so that repeating one allocates nothing.
#pragma once

#include "engine/kkt/body_elimination.hpp"
#include "engine/kkt/constraint_space.hpp"
#include "engine/kkt/problem.hpp"
#include "engine/kkt/reduced_hessian.hpp"
#include "engine/kkt/tree_elimination.hpp"
#include "engine/system/extended.hpp"

namespace flyball {

struct Workspace {
  // Of a problem that is not dense.
  Eliminator& eliminator(const Problem& problem) {
    return problem.elimination() == Elimination::tree ? static_cast<Eliminator&>(tree) : bodies;
  }
  const Eliminator& eliminator(const Problem& problem) const {
    return const_cast<Workspace*>(this)->eliminator(problem);
  }

  Kinematics<double> kinematics;
  Residual<double> residual;
  Magnitudes magnitudes;
  Linearization linearization;
  ConstraintSpace constraints;
  ReducedHessian hessian;
  TreeElimination tree;
  BodyElimination bodies, loops; // of the balance; of the constraints alone
  Eigen::MatrixXd scaled_jacobian, scaled_stiffness, product, reduced;
  Eigen::VectorXd scaled_phi, scaled_force, range_step, target, reduced_rhs, reduced_step, noise, scaled_step,
      scaled_lambda, step, zero_lambda;
  Kinematics<Extended> kinematics_extended;
  Residual<Extended> residual_extended;
  Configuration<Extended> q_extended, lambda_extended;
  Unknowns trial, closing;
  Eigen::VectorXd assembled, moved;
  // By refine(): what the rounding of the scene's own numbers does (rad, m), beside the error of the
  // solution.
  Eigen::VectorXd data_error;
  Eigen::VectorXd unheld; // by refine(): how far (rad, m) a state moves in which no force can be told
};

} // namespace flyball
