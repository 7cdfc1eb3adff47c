// Which coordinates have dry friction, and the addresses of what it gives.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

// In the mechanism's order.
std::vector<CoordinateReference> find_frictions(const Mechanism& mechanism);

const Friction& friction_at(const Mechanism& mechanism, CoordinateReference at);

// "joints.slide.friction.share": of its limit, from -1 to 1.
std::string share_address(const Mechanism& mechanism, CoordinateReference at);

} // namespace flyball
