// The last digits of a solution, and how far they can be believed.
#pragma once

#include "engine/solve/factored_state.hpp"

namespace flyball {

// Absolute, by coordinate of q_R (rad, m).
struct ErrorEstimate {
  // Against the equations: the last correction, what the rounding of the residual does to it, how far
  // redundant loops disagree, and two units in the last place. At a singular state also how far it could be
  // moved before double precision sees an imbalance: at a fold half of the digits.
  Eigen::VectorXd solution;
  // What the rounding of the scene's own numbers adds for whoever compares with the scene.
  Eigen::VectorXd data;
  // How far the state moves along directions in which double precision sees no force: neutral ones, or
  // softer than rounding. Zero where there are none.
  Eigen::VectorXd undetermined;
  bool singular_loops = false; // see at_singular_loops()
};

// The balance in extended precision, in the workspace's residual_extended: at z, or at the state that the
// workspace holds in extended precision. Quaternions of double precision are of unit length to double
// precision only, and scale what they turn: they are normalised.
void evaluate_extended(const Problem& problem, const Unknowns& z, Workspace& w);
void evaluate_extended(const Problem& problem, Workspace& w);

// Corrects a converged state, evaluated and factored in the workspace, by Newton steps on the residual
// evaluated in extended precision (iterative refinement; Higham, Accuracy and Stability of Numerical
// Algorithms, 2002, chapter 12), and estimates its error. Leaves the workspace factored beside the state, by
// no more than was corrected, and evaluated nowhere.
void refine(const Problem& problem, Unknowns& z, const NewtonOutcome& outcome, Workspace& w,
            ErrorEstimate& error);

// Whether in a state without stiffness along some direction, factored, extended precision sees a force there
// that no rounding of the scene's numbers explains: what acts is lost beside what it is the difference of,
// and the state need be none. Of a symmetric dense problem; false of others. Uses the workspace beside the
// state's (elsewhere()).
bool is_pushed_where_soft(const FactoredState& at);

} // namespace flyball
