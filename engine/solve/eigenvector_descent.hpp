// Downhill on the amended potential by each eigenvector of its Hessian on its own: a Newton step where the
// curvature is positive, turned round where it is negative, none longer than a radius, on the manifold of
// closed loops. For few coordinates where the trust region (trust_region.hpp) ends short: its one radius
// serves all directions, and where masses and lengths are many decades apart, or loops close in one pose
// alone, no single one does.
#pragma once

#include "engine/solve/trust_region.hpp"

namespace flyball {

// As descend(), of a dense problem.
DescentOutcome descend_by_eigenvectors(const Problem& problem, Unknowns& z, Workspace& w,
                                       std::vector<double>* history);

} // namespace flyball
