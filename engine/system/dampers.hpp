// Whether dampers act, and whether the motion has a Hamiltonian.
#pragma once

#include "engine/system/parameters.hpp"
#include "engine/system/system.hpp"

namespace flyball {

// In joints, joints that close loops, springs between points and bearings; be it by a number or by a law.
bool has_dampers(const Parameters& parameters);

// All forces have a potential and nothing damps: motions follow Hamilton's equations, with the drives'
// angles as given functions of time, so that the multipliers of periodic ones lie in pairs mu, 1 / mu.
bool is_hamiltonian(const System& system, const Parameters& parameters);

} // namespace flyball
