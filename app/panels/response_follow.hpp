// Branches of equilibria through a state that is given, rather than from the drawn pose.
#pragma once

#include "engine/continuation/branches.hpp"

#include <optional>

namespace flyball {

// The branch of the equilibrium nearest to `state` at its parameter, followed both ways from there, then
// whatever branches off it. Nothing where there is no steady state near it or its parameter lies outside the
// range. Throws SceneError as follow_branches does.
std::optional<ResponseDiagram> follow_through(const Mechanism& mechanism, const std::string& address,
                                              double from, double to, const ResponsePoint& state,
                                              const BranchOptions& options);

} // namespace flyball
