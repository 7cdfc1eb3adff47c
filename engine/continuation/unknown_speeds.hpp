// Points of branches at which rounding leaves nothing of a speed that is found.
#pragma once

#include "engine/continuation/branches.hpp"

#include <string>

namespace flyball {

// A sentence on the first, and how many others there are; empty where none is.
std::string unknown_speeds(const ResponseDiagram& diagram, const std::string& address);

} // namespace flyball
