// Which mode at one point of a branch is which at the next.
#pragma once

#include "engine/stability/mode_motion.hpp"

#include <span>
#include <vector>

namespace flyball {

// The modes at consecutive points of a branch put in one order: entry l of every point, an index into its
// modes or -1, belongs to one line of a Campbell diagram. Matched to what two points before foretell of the
// eigenvalues and, by modal assurance, to the shapes before, so that lines that cross keep their names. Lines
// are as many as the point with the most modes has. `positions` are those of the points along the branch.
std::vector<std::vector<int>> track_modes(std::span<const std::vector<VibrationMode>> points,
                                          std::span<const double> positions);

} // namespace flyball
