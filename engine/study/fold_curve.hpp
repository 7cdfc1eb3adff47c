// Curves in the plane of two parameters: where the equilibria fold, where branches cross, and where a
// coordinate or a measure keeps a value. Traced by pseudo-arclength continuation of the balance together with
// the condition, minimally augmented (Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria,
// 2000, chapters 3 and 4), within a box and both ways.
#pragma once

#include "engine/study/plane_curves.hpp"

namespace flyball {

// Fold and branch-point curves through every fold and branch point found at the starting values. Points are
// accurate to rounding (the condition is exact). Throws SceneError for an address that does not exist.
PlaneCurves fold_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options = {});

// Curves on which what is wanted (see find_wanted) is `value`, in its SI unit. Throws SceneError for an
// address or a coordinate that does not exist or is driven.
PlaneCurves value_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                         const std::string& name, double value, const PlaneOptions& options = {});

} // namespace flyball
