// Newton-Raphson on z = [q_R; lambda] (eqs. 21 and 22). The inertia of the KKT matrix comes with its factors,
// so the definiteness of the balance is known at every iteration.
#pragma once

#include "engine/kkt/workspace.hpp"
#include "engine/solve/tolerances.hpp"

#include <vector>

namespace flyball {

// Evaluates the balance at phase t: kinematics, residual at z.lambda and magnitudes.
void evaluate(const Problem& problem, const Unknowns& z, double t, Workspace& w);
// The rest where the kinematics are at z already.
void evaluate_forces(const Problem& problem, const Unknowns& z, Workspace& w);

// Largest scaled equation of eq. 23: forces relative to the terms they are made of, lengths to the
// mechanism's reach.
double scaled_residual(const Problem& problem, const Workspace& w);

// Linearises and factors the constraints at an evaluated state.
void factor_constraints(const Problem& problem, Workspace& w);

// Of the factored constraints: how many do not follow from others; the multipliers that balance the evaluated
// forces (without multipliers) best, in N or N m; the shortest scaled step that closes the loops.
int independent_rows(const Problem& problem, Workspace& w);
void best_multipliers(const Problem& problem, Workspace& w, Eigen::VectorXd& lambda);
void close(const Problem& problem, Workspace& w, Eigen::VectorXd& scaled_step);

// Linearises and factors at an evaluated state.
void factor(const Problem& problem, const Unknowns& z, Workspace& w);

// At any state, with the multipliers that balance it best: evaluates; and factors, too.
void evaluate_with_multipliers(const Problem& problem, Unknowns& z, Workspace& w);
void factor_with_multipliers(const Problem& problem, Unknowns& z, Workspace& w);

// The Newton step at a factored state: `step` (scaled, tangent) and `lambda` (new multipliers) for the
// balance `f` without constraint forces (N m, N) and the constraint values `phi`.
void newton_step(const Problem& problem, const Eigen::VectorXd& f, const Eigen::VectorXd& phi, Workspace& w,
                 Eigen::VectorXd& scaled_step, Eigen::VectorXd& lambda);

// The step from an evaluated and factored state in w.scaled_step, and the multipliers there: solved for
// whole, so that nothing stays of those of worse places, or corrected, so that nothing stays of the rounding
// of the last solve.
void find_step(const Problem& problem, bool whole, Unknowns& z, Workspace& w);

struct NewtonSettings {
  int max_iterations = 30;
  bool damped = false; // halve steps until the scaled residual falls
  // 1/s^2, of the metric added to the stiffness: it keeps still what nothing resists, where rounding and what
  // is left of the forces look like a little stiffness of either sign (regularised Newton method; Li,
  // Fukushima, Qi, Yamashita, Regularized Newton methods for convex minimization problems with singular
  // solutions, 2004).
  double proximal = 0;
  bool trusting = false;   // stop where the next step would be within the tolerance by the last two's ratio
  bool to_minimum = false; // of a large mechanism: give up where the balance is indefinite
  bool impatient =
      false;             // give up where steps stay long: in large mechanisms they lead nowhere and cost much
  bool factored = false; // the balance at z is evaluated and factored, and the first step takes that
};

struct NewtonOutcome {
  bool converged = false;
  bool linear = false; // converged in the residual while steps still shrank slowly: a singular state
  bool falls = false;  // gave up for settings.to_minimum at z, where the balance is factored
  int iterations = 0;
  double largest_step = 0; // scaled
  double last_step = 0;    // scaled
};

// Runs from z, in place. Appends the scaled residual before every iteration and at the end to `history`.
NewtonOutcome newton(const Problem& problem, Unknowns& z, Workspace& w, const NewtonSettings& settings,
                     std::vector<double>* history);

// Closes the loops from q by shortest steps (Gauss-Newton with halving). False where they cannot be closed.
bool assemble(const Problem& problem, Eigen::VectorXd& q, double t, Workspace& w);

} // namespace flyball
