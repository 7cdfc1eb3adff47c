// Which coordinates meet in the linearised balance: those on one way to the root, and those that move an
// element between two bodies.
#pragma once

#include "engine/system/system.hpp"

#include <functional>

namespace flyball {

// Calls visit(i, j) for every pair, some more than once.
void for_coordinate_pairs(const System& system, const std::function<void(int, int)>& visit);

// How often that would call visit, found without doing so; stops counting beyond `enough`.
long count_coordinate_pairs(const System& system, long enough);

// Of everything that the pairs depend on.
std::size_t pattern_hash(const System& system);

} // namespace flyball
