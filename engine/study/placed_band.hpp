// The band of dry friction by where joints stand: from the state along places at which each joint's friction
// stays within its limit, through whatever the balance without friction would fold at, and between stops
// where nothing presses. With several joints as with one.
#pragma once

#include "engine/solve/solution.hpp"
#include "engine/study/friction_band.hpp"

namespace flyball {

// Of what is told of the state by these names. `independent`: of find_frictions(), as of Holding; `reach` in
// m. Each extent is an extremum nearby, or infinite where what goes round comes back to where it was, or goes
// on farther than it is followed. Without shares and errors. Nothing found where the places are singular,
// too, or the way to an extremum is lost: the message says so.
FrictionBand find_placed_band(const Mechanism& mechanism, const Solution& state,
                              const std::vector<std::string>& names,
                              const std::vector<std::size_t>& independent, double reach,
                              const std::atomic<bool>* cancel);

} // namespace flyball
