// What proves that a motion linearised about a steady state is stable or unstable. Each certificate says so
// or leaves it open.
#pragma once

#include "engine/solve/factored_state.hpp"
#include "engine/solve/solution.hpp"
#include "engine/stability/steady_motion.hpp"

namespace flyball {

struct Verdict {
  std::optional<bool> stable;
  std::optional<StabilityReason> reason; // of what is open, too, where something is known of it
};

// That an energy is kept or falls, and has a strict minimum at the steady state (Lyapunov, Dirichlet): at
// kept momenta Routh's potential beside a kinetic energy; of what torques drive the energy less the sum of
// w L, w its speeds and L the angular momenta of its shafts, which falls at the rate of
// sum_i (T_i(w') - T_i(w)) (w'_i - w_i) < 0 and what dampers take, where torques T depend on these speeds
// alone and fall as they grow. Stable or open.
Verdict by_energy(const System& system, const SteadyMotion& motion);

// How the balance on the constraints changes beside the state.
struct BalanceShape {
  std::optional<bool> falls; // whether the potential falls some way, where there is one
  int null = 0, neutral = 0; // null directions, and of these those of neutral_directions()
};
// How many eigenvalues belong to null directions of the balance at prescribed speeds, `hessian` its
// derivative.
int count_null_eigenvalues(const FactoredState& at, const SteadyMotion& motion, const ReducedHessian& hessian,
                           bool potential);
// By the eigenvalues of `motion`, of which the `null_eigenvalues` smallest belong to null directions, and by
// what has neither mass nor damping, of which they do not tell.
Verdict by_spectrum(const FactoredState& at, const SteadyMotion& motion,
                    std::vector<std::complex<double>> eigenvalues, int null_eigenvalues,
                    const BalanceShape& balance);

// How far from zero (1/s) rounding may put the real part of an eigenvalue, `largest` the size of the largest.
double real_part_rounding(std::complex<double> s, double largest);

} // namespace flyball
