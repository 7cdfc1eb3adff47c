// Where the modes along a branch swing as often as an order of the drive's speed.
#pragma once

#include "engine/study/branch_modes.hpp"

namespace flyball {

// Where one line of a branch meets that of one order: crossings, double roots where it only touches, and
// where it runs along. `branch` is what `modes` told of the points of `followed`.
std::vector<CriticalSpeed> order_crossings(BranchModes& modes, const ResponseBranch& followed,
                                           const CampbellBranch& branch, std::size_t line, double order);

} // namespace flyball
