// A system whose drives are coordinates like the others, for the equations of motion: there a driven
// coordinate is a known function of time, its row of the balance is what the drive must supply, and
// derivatives with time are derivatives with these coordinates.
#pragma once

#include "engine/system/parameters.hpp"

namespace flyball {

// The same links and elements; driven coordinates come after the free ones, in the order of
// System::drives: entry nq + d of the configuration and nv + d of the tangent.
System released(const System& system);

// Fills the driven entries of a configuration of the released system at time t (s) after the drawn phase, and
// of its velocity.
void set_drives(const System& system, const Parameters& parameters, double t, Eigen::VectorXd& q,
                Eigen::VectorXd& u);

} // namespace flyball
