// The boundary of hunting: where a damped pair of eigenvalues stands on the imaginary axis, in the plane of
// two parameters (Vyshnegradsky's diagram, 1877), with the first Lyapunov coefficient at each point
// (Kuznetsov, Elements of Applied Bifurcation Theory, 2004, chapters 8 and 10). Soft turns into hard, and the
// frequency goes to zero, at points that are found as roots.
#pragma once

#include "engine/study/plane_curves.hpp"

namespace flyball {

// Curves through every Hopf point found at the starting values, of steady states whose motion does not turn
// with the drives. Parameters are accurate to the rounding of eigenvalues. Throws SceneError for an address
// that does not exist.
PlaneCurves hopf_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options = {});

} // namespace flyball
