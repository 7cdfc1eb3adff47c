// The modes of the linearised motion whose eigenvalues are nearest to zero, of mechanisms too large for the
// matrices: M q'' + (C + G) q' + K q = 0 by shift and invert (Tisseur and Meerbergen, The quadratic
// eigenvalue problem, 2001), at a cost that grows with the bodies.
#pragma once

#include "engine/stability/modes.hpp"

namespace flyball {

struct LowestModes {
  std::vector<VibrationMode> modes; // by frequency; fewer than asked for where there are no more
  std::string failure;              // a sentence; empty where they were found
};

// The `count` modes of smallest |s|, conjugate pairs counted once, of a steady state z of a problem that is
// not dense and whose linearised motion is the same at every phase of the drives. Each is accepted by its
// residual, and none is left out unless a random vector missed it.
LowestModes find_lowest_modes(const Problem& problem, const Unknowns& z, int count, Workspace& w);

} // namespace flyball
