// Whether a mechanism can be written down at all: a scene file has no word for infinity.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

// Every number of it, also those without an address.
bool is_finite(const Mechanism& mechanism);

} // namespace flyball
