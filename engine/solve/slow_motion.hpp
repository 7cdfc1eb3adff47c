// Where a mechanism driven by torques goes from a start, slowly: along the flow W q' = -f, f the balance and
// W the metric of steps (kkt/kkt_system.hpp). What turns gathers or loses speed by what its torque has in
// excess, with the inertia it has, and the coordinates creep downhill meanwhile; where f vanishes it rests.
// It comes to states that are stable in the main, where Newton-Raphson takes whatever is near.
//
// Pseudo-transient continuation (Kelley, Keyes, Convergence analysis of pseudo-transient continuation, 1998):
// steps of the linearly implicit Euler method, (K + W / h) x = -f, as long as their model holds, and
// Newton-Raphson at the end. Along a direction of stiffness -k such a step grows until h = 1 / k in the units
// of W and goes backwards beyond, to the unstable state that the motion leaves: steps stay within half of
// that, -f^T x >= x^T W x / (2 h). Of trees the pivots tell of each direction by itself: K + W / h must have
// none of negative stiffness.
//
// What a speed gains counts by the time of a radian at its unit (kkt/speed_time.hpp), and so do the first
// step and its bounds: the way is the same in another unit of time.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

// Runs from z, in place, with its loops closed. Not converged where it goes on without end, or takes too
// long. Appends the scaled residuals to `history`.
NewtonOutcome follow_slow_motion(const Problem& problem, Unknowns& z, Workspace& w,
                                 std::vector<double>* history);

} // namespace flyball
