// In which order the unknowns of a symmetric matrix are eliminated.
#pragma once

#include "engine/linear/sparse_pattern.hpp"

#include <vector>

namespace flyball {

// By approximate minimum fill, but unknowns with nothing on the diagonal, multipliers, behind what they tie.
// By unknown its place, from 1; empty where minimum fill alone will do.
std::vector<int> elimination_order(const SparsePattern& pattern);

} // namespace flyball
