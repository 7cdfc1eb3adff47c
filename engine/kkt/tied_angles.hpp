// Loops that tie the angles of what turns at speeds that are found to each other or to coordinates: two
// shafts with bearings of their own and a spring in a joint between them.
//
// The balance takes loops for closed at any speed that is found: angles are not among its unknowns, and the
// columns of speeds are zero in the Jacobian of the loops. The forces of such loops turn the shafts all the
// same.
#pragma once

#include "engine/kkt/problem.hpp"

namespace flyball {

// Whether any does, at evaluated kinematics. No allocation.
bool loops_tie_angles(const Problem& problem, const Kinematics<double>& kinematics);

// The gradients of the loops (rows, nv) with all that moves free to, from those of the balance.
Eigen::MatrixXd constraints_of_motion(const System& system, const Parameters& parameters,
                                      const Kinematics<double>& kinematics,
                                      const Eigen::MatrixXd& of_balance);

// Where loops tie angles: the multipliers, scaled and of least norm, that balance a scaled force best. False
// where none do.
bool balance_with_tied_angles(const Problem& problem, const Kinematics<double>& kinematics,
                              const Eigen::VectorXd& scaled_force, Eigen::VectorXd& scaled_lambda);

} // namespace flyball
