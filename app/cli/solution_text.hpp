// A solution as a person reads it in a terminal: no more digits than the error estimate supports, every
// number with its unit.
#pragma once

#include "engine/equilibrium/solution.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball::cli {

std::string to_text(const Mechanism& mechanism, const Solution& solution);

} // namespace flyball::cli
