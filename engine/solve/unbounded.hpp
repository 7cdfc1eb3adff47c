// Why a search found nothing, where something runs away: coordinates along which the forces push on without
// end, so that the amended potential has no lower bound. A slide without a spring under gravity is the most
// common of them, and for a person something else than a search that did not converge.
#pragma once

#include "engine/kkt/problem.hpp"
#include "engine/kkt/workspace.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

// Along a slide (N/m), at the start.
struct Softening {
  double held = 0;   // what its springs, or whatever else holds it, grow by
  double driven = 0; // what the centrifugal force at these speeds grows by
};

struct Unbounded {
  std::vector<UnheldCoordinate> coordinates; // empty: nothing of the kind was found
  bool by_weight = false;                    // without gravity the forces do not push this way
  bool by_inertia = false;                   // without the drives' motion they do not
  // Of each of these, where the drives' motion pushes slides that springs hold, though not enough.
  std::vector<Softening> softened;
  bool for_a_moment = false; // at other phases of the drives they do not push this way
};

// From `start` (a configuration, loops open or closed) of a problem without a steady state. Two tests: along
// each coordinate alone, whether the generalised force keeps its sign and loses nothing of its size out to a
// thousand times the mechanism's reach, or over whole turns; then, where there is a potential, which
// coordinates run off in a descent that finds no bottom. Empty where neither decides, where loops cannot be
// closed and where the problem is cancelled.
Unbounded find_unbounded(const Problem& problem, const Eigen::VectorXd& start, Workspace& w);

} // namespace flyball
