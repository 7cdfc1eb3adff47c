// Springs and dampers that stand on a kink of their laws (force_law.hpp), where the slope jumps.
#pragma once

#include "engine/kkt/workspace.hpp"

#include <string>

namespace flyball {

struct Kinks {
  bool spring = false, damper = false; // stands on one
  std::string message;                 // a sentence on each, or empty
};
// Uses the workspace's kinematics. A damper in a joint rests in a steady state.
Kinks find_kinks(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& q, Workspace& w);

} // namespace flyball
