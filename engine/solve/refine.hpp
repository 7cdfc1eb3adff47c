// The last digits of a solution, and how far they can be believed.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

// Corrects a converged state, evaluated and factored in the workspace, by Newton steps on the residual
// evaluated in extended precision (iterative refinement; Higham, Accuracy and Stability of Numerical
// Algorithms, 2002, chapter 12), and fills `error` with the estimated absolute error of each coordinate of
// q_R (rad, m): the last correction, what the rounding of the residual does to it, how far redundant loops
// disagree, and two units in the last place. At a singular state also how far it could be moved before double
// precision can tell: at a fold half of the digits. Workspace::data_error gets what the rounding of the
// scene's numbers adds for whoever compares with the scene rather than with the equations.
void refine(const Problem& problem, Unknowns& z, const NewtonOutcome& outcome, Workspace& w,
            Eigen::VectorXd& error);

} // namespace flyball
