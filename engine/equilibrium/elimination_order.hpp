// In which order the unknowns of a symmetric matrix are eliminated.
#pragma once

#include "engine/equilibrium/sparse_pattern.hpp"

#include <vector>

namespace flyball {

// By approximate minimum fill, but unknowns with nothing on the diagonal, multipliers, behind what they tie;
// the `last` ones (from 1) at the end. By unknown its place, from 1; empty where minimum fill alone will do.
// `copy` of MUMPS is used for it.
std::vector<int> elimination_order(const SparsePattern& pattern, const std::vector<int>& last, int copy);

} // namespace flyball
