// What is said of springs, dampers, vanes and drives that stand on a kink of their laws.
#pragma once

#include "engine/stability/stability.hpp"

#include <string>

namespace flyball {

// A sentence on each, or empty.
std::string kink_message(const System& system, const Mechanism& mechanism, const Stability& stability);

} // namespace flyball
