// That slow changes do not matter: where all that moves dies out at every phase much faster than the drives
// turn, motions beside a state contract all the time (Desoer, Slowly varying system x' = A(t) x, IEEE Trans.
// Automatic Control 14, 1969).
#pragma once

#include "engine/stability/periodic_motion.hpp"

#include <atomic>
#include <optional>

namespace flyball {

// How much motions beside contract at least over a period: the logarithm, above zero, so that all multipliers
// are smaller than exp(-it). By x^T P(t) x with A^T P + P A = -I at each phase, whose derivative along the
// motion is -|x|^2 + x^T P' x; P' has to take no more than the half of that at each of the phases looked at,
// four to each harmonic of A. `fastest` and `slowest` (1/s) are sizes of eigenvalues of A. Nothing where that
// does not hold: it is sufficient, not necessary.
std::optional<double> contraction(const PeriodicMotion& motion, double fastest, double slowest,
                                  const std::atomic<bool>* cancel);

} // namespace flyball
