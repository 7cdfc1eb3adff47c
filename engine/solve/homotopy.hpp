// From rest to the full drive speeds: solve the mechanism standing still, then follow the state as the
// squared speed grows, with steps halved where Newton-Raphson fails.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

NewtonOutcome homotopy(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history);

} // namespace flyball
