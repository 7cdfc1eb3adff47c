// That two eigenvalues of the linearised motion have the sum zero: a pair +-i w on the imaginary axis where
// their product w^2 is positive (Hopf), +-r where it is negative. Sum and product are smooth where the two
// meet at zero, too, though the eigenvalues are not (Govaerts, Numerical Methods for Bifurcations of
// Dynamical Equilibria, 2000, 5.3). Which two is told by their product at a state beside,
// ExtendedState::pair.
#pragma once

#include "engine/continuation/extended_balance.hpp"

#include <optional>

namespace flyball {

// Two eigenvalues (1/s), both real or conjugate.
struct EigenvaluePair {
  double sum = 0, product = 0; // 1/s, 1/s^2
};

// Those with the sum nearest to zero and the product nearest to `product`. Nothing where there are no two.
std::optional<EigenvaluePair> pair_near(const std::vector<std::complex<double>>& spectrum, double product);

// The sum over `scale` (1/s) is zero.
Condition pair_crosses(double scale);

// Of a state: the product of its pair. Nothing where its eigenvalues cannot be found.
std::optional<double> pair_product(ExtendedBalance& balance, const ExtendedState& state);

} // namespace flyball
