// The first number in an answer that is none, named.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/dynamics/simulation.hpp"

namespace flyball::fuzz {

bool finite(const Pose& pose);
std::optional<std::string> not_finite(const Solution& solution);
std::optional<std::string> not_finite(const ResponsePoint& point);
std::optional<std::string> not_finite(const Run& run);

} // namespace flyball::fuzz
