// How large the terms of laws are: those are evaluated in double precision, whatever the rest of the balance
// is, and so are what rounds most of it.
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

// Of a law's force at a deflection and a position: what it is, and what rounding of the numbers that it is
// given by makes of it.
double law_size(const BoundLaw& law, double deflection, double position);

// Adds them to `force`, by coordinate of q_R (N m or N): of springs, and of torques and loads of drives.
void add_law_sizes(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                   const Kinematics<double>& kinematics, Eigen::VectorXd& force);

} // namespace flyball
