// States that are no minimum of the amended potential, which gyroscopic forces keep nevertheless as long as
// there is no damping (Thomson, Tait and Chetaev; Merkin, Introduction to the Theory of Stability, 1997,
// chapter 6).
#pragma once

#include "engine/kkt/workspace.hpp"

namespace flyball {

// Whether a steady state is gyroscopically stable: the amended potential falls from it, no damping acts in
// what falls, and all eigenvalues of the linearised motion lie on the imaginary axis; where that motion turns
// with the drives, all multipliers on the unit circle or within it. False for mechanisms of
// more than largest_for_eigenvalues coordinates. The workspace is used for it.
bool is_gyroscopically_stable(const Problem& problem, const Unknowns& z, Workspace& w);

// Whether the dampers make M x'' + V x' + K x = 0 unstable although its eigenvalues are too close to the axis
// to tell. `basis` spans the scaled displacements that x counts; M (positive semidefinite), V and K
// (symmetric) are in them. No eigenvalue can cross the axis as damping is multiplied by a positive number,
// for one on the axis is not damped at all: so this looks at much stronger dampers of the same pattern. The
// kinematics must be at q.
std::optional<bool> damping_destabilizes(const Problem& problem, const Eigen::VectorXd& q,
                                         const Eigen::MatrixXd& basis, const Eigen::MatrixXd& mass,
                                         const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& stiffness,
                                         const Workspace& w);

} // namespace flyball
