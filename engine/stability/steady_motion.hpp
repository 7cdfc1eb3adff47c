// The linearised motion about a steady state at the momenta that are kept, with the phases of what torques
// drive told apart: what energy and eigenvalues judge.
#pragma once

#include "engine/solve/newton.hpp"
#include "engine/stability/routh.hpp"

#include <complex>

namespace flyball {

// On the null space of the constraints.
struct SteadyMotion : LinearPencil {
  Eigen::MatrixXd phases;  // orthonormal, by column: of what torques drive, along which nothing changes
  Eigen::VectorXd noise;   // below what size a diagonal entry of the stiffness is rounding
  Eigen::VectorXd inertia; // what a diagonal entry of the mass is made of
};

// Of a dense problem that is evaluated and factored at z in the workspace, with its best multipliers. Nothing
// where a decomposition fails.
std::optional<SteadyMotion> steady_motion(const Problem& problem, const Unknowns& z, Workspace& w);

// Its eigenvalues (1/s, by size of the imaginary part), those of the phases left out. Nothing where they
// cannot be found. `few_digits`: see eigenvalues_without_cyclic().
std::optional<std::vector<std::complex<double>>>
eigenvalues_of(const Problem& problem, const SteadyMotion& motion, bool* few_digits = nullptr);
// Of the motion linearised at the drawn phase, whatever it is at others.
std::optional<std::vector<std::complex<double>>> motion_eigenvalues(const Problem& problem, const Unknowns& z,
                                                                    Workspace& w);

} // namespace flyball
