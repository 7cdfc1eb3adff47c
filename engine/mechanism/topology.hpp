// What a compiled system depends on of a mechanism.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <vector>

namespace flyball {

// Parts and connections, as opposed to numbers.
bool same_topology(const Mechanism& a, const Mechanism& b);

// By joints' coordinates and forces: whether there is a damper, which compiling looks at. Of the other
// numbers it asks only whether a label is zero, for which of two trees that serve alike.
void find_dampers(const Mechanism& mechanism, std::vector<bool>& dampers);

} // namespace flyball
