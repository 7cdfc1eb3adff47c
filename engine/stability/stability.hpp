// Stability of a steady state: the energy criterion where a potential exists, and the eigenvalues of the
// linearised motion M q'' + (C + G) q' + K q = 0 on the tangent space of the constraints; where that motion
// turns with the drives, the multipliers of Floquet's theory alone.
#pragma once

#include "engine/stability/certificates.hpp"
#include "engine/stability/floquet.hpp"
#include "engine/stability/kinks.hpp"

namespace flyball {

// Coordinates up to which eigenvalues are found without being asked for.
inline constexpr int largest_for_eigenvalues = 200;

struct Stability : Verdict {
  // 1/s, by size of the imaginary part: of the linearised motion, or Floquet's exponents.
  std::optional<std::vector<std::complex<double>>> eigenvalues;
  int null_eigenvalues = 0;       // at most as many of these, the smallest, belong to null directions
  std::optional<Floquet> floquet; // where the linearised motion turns with the drives
  std::optional<FloquetFailure> floquet_failure; // where it does and there are no multipliers
  std::vector<int> neutral; // coordinates of q_R that take part in directions nothing resists
  std::vector<Kink> kinks;  // of laws, on which it stands
  // The angle of something at a found speed matters (phase_stiffness.hpp), and what it makes of the motion is
  // not told: of what keeps its momentum, or turns unlike others.
  bool angles_leave_open = false;
  bool kinks_leave_open = false; // stable or not: the sides differ, or there is no potential to compare them
  // Those directions, of the matrices (neutral_directions.hpp): (nv, count), scaled; empty where pivots
  // decide.
  Eigen::MatrixXd neutral_directions;
  // Eigenvalues far below the largest have few digits: they were looked at for their signs alone.
  bool few_digits = false;
};

// Whether f is the gradient of the amended potential at a steady state z although drives ride on drives:
// whether the scaled `stiffness` there is symmetric and agrees with the potential's second differences, which
// are taken in `w`.
bool has_potential(const Problem& problem, const Unknowns& z, const Eigen::MatrixXd& stiffness, Workspace& w);

// Whether the linearised motion turns with the drives, as far as is known: comparing it over the phases
// would take too long in very large mechanisms.
bool may_vary(const Problem& problem, const Unknowns& z, const std::vector<double>& phases, Workspace& w);

// Of a steady state. Of a dense problem `with_eigenvalues` asks for the full picture, else only the sign of a
// minimum is found; of others the signs of the pivots decide (pivot_stability.hpp). On kinks of laws it is
// what both sides have in common (kink_stability.hpp).
Stability find_stability(const FactoredState& at, bool with_eigenvalues);
// Taking the slopes of all laws as they are evaluated.
Stability find_smooth_stability(const FactoredState& at, bool with_eigenvalues);

} // namespace flyball
