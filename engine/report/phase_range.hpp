// Mean and extremes of what changes with the phase of the drives, over all phases they can take.
//
// Drives whose speeds have a common measure return together after a common period: one angle tells where they
// are. Others, in groups of a common period each, come as near as one likes to every combination of their
// groups' angles (Kronecker), so that means over time are means over all angles.
#pragma once

#include "engine/kkt/problem.hpp"
#include "engine/kkt/workspace.hpp"
#include "engine/solve/solution.hpp"

#include <span>

namespace flyball {

// Of the torques of some motors in a steady state. Nothing where the drives never return, or have more than
// three groups, or two or three of so many turns that too many phases would have to be looked at.
std::vector<std::optional<PhaseRange>> drive_ranges(const Problem& problem, const Eigen::VectorXd& q,
                                                    std::span<const int> motors, Workspace& w);

} // namespace flyball
