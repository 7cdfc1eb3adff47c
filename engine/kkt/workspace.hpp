// The balance at one state: its evaluation, its KKT matrix, and the storage that solves reuse, so that
// repeating one allocates nothing.
#pragma once

#include "engine/kkt/dense_kkt.hpp"
#include "engine/kkt/sparse_kkt.hpp"
#include "engine/kkt/speeds_kkt.hpp"
#include "engine/kkt/tree_kkt.hpp"
#include "engine/system/extended.hpp"

#include <memory>

namespace flyball {

struct Workspace : Evaluation {
  KktSystem& kkt(const Problem& problem) {
    if (problem.form == KktForm::tree && !problem.system.torques.empty()) {
      if (problem.as_gradient) return speeds.at_given_speeds();
      return speeds;
    }
    switch (problem.form) {
    case KktForm::tree: return tree;
    case KktForm::sparse: return sparse;
    case KktForm::dense: break;
    }
    return dense;
  }

  // The matrices themselves; null where the problem is too large for them.
  DenseKkt* matrices(const Problem& problem) { return problem.form == KktForm::dense ? &dense : nullptr; }

  DenseKkt dense;
  TreeKkt tree;
  SpeedsKkt speeds;
  SparseKkt sparse;
  Eigen::VectorXd scaled_phi, scaled_force, projected, scaled_step, scaled_lambda, step, zero_lambda;
  Kinematics<Extended> kinematics_extended;
  Residual<Extended> residual_extended;
  Configuration<Extended> q_extended, lambda_extended;
  Unknowns trial, closing;
  Eigen::VectorXd assembled, moved;

  // Another balance, for states beside this one: made when first asked for.
  Workspace& elsewhere() {
    if (!elsewhere_) elsewhere_ = std::make_unique<Workspace>();
    return *elsewhere_;
  }

 private:
  std::unique_ptr<Workspace> elsewhere_;
};

} // namespace flyball
