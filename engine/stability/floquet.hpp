// Floquet's theory of a linearised motion whose matrices turn with the drives (Floquet 1883; Meirovitch,
// Methods of Analytical Dynamics, section 7.8): with x' = A(t) x and A(t + T) = A(t) what a motion is after a
// period T is the monodromy matrix times what it was before. Its eigenvalues, the multipliers mu, decide what
// grows: |mu| > 1.
#pragma once

#include "engine/solve/newton.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

// Why there are no multipliers.
enum class FloquetFailure {
  no_period, // the drives that matter have no common period
  singular,  // without mass in directions that turn, or without damping and stiffness in one that has no mass
  unresolved, // a period takes more steps than are reasonable
  cancelled,
};

struct FloquetOutcome {
  std::optional<Floquet> result;
  FloquetFailure failure = FloquetFailure::no_period; // where there is no result
};

// Of the steady state q, where motion_varies(). The matrices are Fourier series through samples over the
// period, of which there are as many as it takes; the monodromy matrix is a product of exponentials by
// Magnus' expansion of order six (Blanes, Casas, Oteo, Ros, The Magnus expansion and some of its
// applications, 2009, section 5.3.2), which keeps multipliers of motions without damping on the unit circle.
// Steps are halved until the multipliers agree. Over periods that are very long beside what dies out the
// multipliers are told as zero, with a bound for an error, where contraction() says so. Where speeds are
// found the multiplier 1 of each phase is left out, and where momentum is kept the one of other momenta.
FloquetOutcome find_floquet(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);

// Whether motions beside stay near, by the multipliers of a period; `error`: estimated, of the largest. False
// where one lies outside the unit circle by more than some errors. Those of `neutral` directions (a rotation
// or shift that nothing resists, and its rate) lie at 1 and do not count, but leave open what is true; so do
// those that the error may have put on either side, except where the motion `has_hamiltonian`: then they
// are on the circle and, apart from each other, stay there.
std::optional<bool> stable_by_multipliers(std::vector<std::complex<double>> multipliers, double error,
                                          int neutral, bool has_hamiltonian);

// ln(mu) / T, 1/s: growth rates and frequencies, these but for whole turns a period, by size of the imaginary
// part. Multipliers so small that they are rounding beside the largest are left out.
std::vector<std::complex<double>> floquet_exponents(const Floquet& floquet);

} // namespace flyball
