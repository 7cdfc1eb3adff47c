// Stability of a steady state: the energy criterion where a potential exists, and the eigenvalues of the
// linearised motion M q'' + (C + G) q' + K q = 0 on the tangent space of the constraints.
#pragma once

#include "engine/equilibrium/newton.hpp"
#include "engine/equilibrium/solution.hpp"

#include <complex>

namespace flyball {

// Coordinates up to which eigenvalues are found without being asked for.
inline constexpr int largest_for_eigenvalues = 200;

struct Stability {
  std::optional<bool> stable;
  std::optional<StabilityReason> reason;
  std::optional<std::vector<std::complex<double>>> eigenvalues; // 1/s, by size of the imaginary part
  std::vector<int> neutral; // coordinates of q_R that take part in directions nothing resists
  double condition = 0;     // 2-norm, of the scaled equations
};

// Finite eigenvalues of the pencil s^2 M + s D + K. M may be singular in any direction (massless
// coordinates): directions without mass and damping are condensed statically, others leave as infinite
// eigenvalues.
std::vector<std::complex<double>> pencil_eigenvalues(const Eigen::MatrixXd& mass,
                                                     const Eigen::MatrixXd& velocity,
                                                     const Eigen::MatrixXd& stiffness);

// Whether f is the gradient of the amended potential at this state although drives ride on drives: its
// Hessian on the potential's second differences, to be asked only at a steady state.
bool has_potential(const Problem& problem, const Unknowns& z, Workspace& w);

// z must be a steady state. `with_eigenvalues` asks for the full picture, else only the sign is found.
Stability find_stability(const Problem& problem, const Unknowns& z, bool with_eigenvalues, Workspace& w);

} // namespace flyball
