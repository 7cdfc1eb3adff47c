// The unknowns of a sparse matrix in two halves that meet by what is between them alone.
#pragma once

#include "engine/equilibrium/sparse_pattern.hpp"

#include <vector>

namespace flyball {

enum class Side : unsigned char { first, second, between };

// By unknown, of a symmetric matrix. What is between is a level of equal distance from one end of the graph
// (George, Liu, An automatic nested dissection algorithm for irregular finite element problems, 1978), with
// pieces of a few unknowns that meet nothing else.
std::vector<Side> halve(const SparsePattern& pattern);

} // namespace flyball
