// Storage that solves reuse, so that repeating one allocates nothing.
#pragma once

#include "engine/kkt/dense_kkt.hpp"
#include "engine/kkt/sparse_kkt.hpp"
#include "engine/kkt/tree_kkt.hpp"
#include "engine/system/extended.hpp"

namespace flyball {

struct Workspace : Evaluation {
  KktSystem& kkt(const Problem& problem) {
    switch (problem.form) {
    case KktForm::tree: return tree;
    case KktForm::sparse: return sparse;
    case KktForm::dense: break;
    }
    return dense;
  }
  const KktSystem& kkt(const Problem& problem) const { return const_cast<Workspace*>(this)->kkt(problem); }

  // The matrices themselves; null where the problem is too large for them.
  DenseKkt* matrices(const Problem& problem) { return problem.form == KktForm::dense ? &dense : nullptr; }

  DenseKkt dense;
  TreeKkt tree;
  SparseKkt sparse;
  Eigen::VectorXd scaled_phi, scaled_force, projected, scaled_step, scaled_lambda, step, zero_lambda;
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
