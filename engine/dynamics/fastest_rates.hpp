// The fastest rates of a motion without its matrices: for mechanisms too large for all of them.
#pragma once

#include "engine/dynamics/equations.hpp"

#include <complex>

namespace flyball {

// The outermost eigenvalues (1/s) of the motion linearised at an evaluated state (t, q, s): those Ritz values
// of Arnoldi's iteration that are settled, the largest at least, of at most 40 evaluations on a Krylov
// space of difference quotients. Empty where the equations cannot be evaluated nearby.
std::vector<std::complex<double>> fastest_rates(Equations& equations, double t, const Eigen::VectorXd& q,
                                                const Eigen::VectorXd& s);

} // namespace flyball
