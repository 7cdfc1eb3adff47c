// The order in which the unknowns of a sparse matrix are eliminated.
#pragma once

#include "engine/linear/sparse_pattern.hpp"

#include <vector>

namespace flyball {

// Unknowns by their place in the order: motions by approximate minimum degree (Amestoy, Davis, Duff, An
// approximate minimum degree ordering algorithm, 1996), where those that a row ties meet each other; and
// every multiplier after the first body whose motions its row ties, which as a rule come one after the other:
// its pivot is then away from zero where the rows so far are independent, and nothing waits for it.
std::vector<int> elimination_order(const SparsePattern& pattern);

} // namespace flyball
