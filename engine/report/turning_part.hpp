// Of a state that balances at one phase of the drives and not at another: what turns with them.
#pragma once

#include "engine/kkt/problem.hpp"
#include "engine/kkt/workspace.hpp"

#include <string>

namespace flyball {

// The part whose force on the coordinates q changes most from the drawn phase to `phase` (s), as a phrase:
// "the weight of bob", "the force push", "the inertia of rotor". Found by evaluating each part's forces
// alone.
std::string turning_part(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& q,
                         double phase, Workspace& w);

// Whether that is gravity's doing alone, so that turning it along the axis, or off, would mend it.
bool weight_turns(const Problem& problem, const Eigen::VectorXd& q, double phase, Workspace& w);

} // namespace flyball
