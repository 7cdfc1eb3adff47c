// Downhill on the amended potential to a stable state: Newton steps with negative curvature turned round, on
// the manifold of closed loops, within a trust region.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

enum class DescentEnd {
  minimum,   // strict, or flat only along directions without stiffness
  near,      // the quadratic model serves as far as it goes, and that is not far
  unbounded, // the potential falls on, hundreds of times the reach away
  stalled,   // no step lowers it: not a potential after all, or rounding
  cancelled,
};

struct DescentOutcome {
  DescentEnd end = DescentEnd::stalled;
  int iterations = 0;
  bool factored = false; // the balance at z, by the problem's elimination
};

// From z.q, whose loops must be closed; never raises the potential. Appends the scaled residual to `history`.
DescentOutcome descend(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history);

} // namespace flyball
