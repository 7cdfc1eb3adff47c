// Drives by torque in what is reported: the state with its speeds prescribed, and why there is none.
#pragma once

#include "engine/kkt/workspace.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"

#include <span>

namespace flyball {

// The stability of a state found, its speeds prescribed; nothing where no drive finds one.
std::optional<AtConstantSpeed>
stability_at_constant_speed(const Mechanism& mechanism, const System& system, const Eigen::VectorXd& q,
                            const std::vector<CoordinateSolution>& coordinates);

// The same of a state that stands turned against the drawn pose (search/phase_search.hpp), at the angles of
// `problem`, which stay as found.
std::optional<AtConstantSpeed>
turned_stability_at_constant_speed(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                                   const std::vector<CoordinateSolution>& coordinates);

// Why no steady speed was found: what the drives give, and what turning takes, where the search for it
// began. Empty where that tells nothing.
std::string missing_speed_message(const Mechanism& mechanism, const Problem& problem, Workspace& w);

// Of the coordinates of q_R that take part in directions that nothing resists: that nothing determines the
// speeds of drives among them, and why; empty where there are none.
std::string undetermined_speed_message(const Mechanism& mechanism, const System& system,
                                       std::span<const int> neutral);

} // namespace flyball
