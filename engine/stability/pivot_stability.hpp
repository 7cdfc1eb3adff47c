// What the inertia of the KKT matrix, by the signs of its pivots, says of stability, at the cost of an
// elimination and without eigenvalues.
#pragma once

#include "engine/stability/stability.hpp"

namespace flyball {

// Of a steady state of a problem that is not dense. The signs of the pivots
// decide where there is a potential: a minimum is stable; an odd number of negative ones is unstable whatever
// gyroscopic forces do (Thomson and Tait; Chetayev), and so is any where there are none or every coordinate
// is damped. Else nothing is decided and `reason` stays empty; where the motion turns with the drives that is
// said.
Stability find_pivot_stability(const FactoredState& at);

} // namespace flyball
