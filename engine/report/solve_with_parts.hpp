// The steady state in which dry friction plays given parts.
#pragma once

#include "engine/report/friction_parts.hpp"

namespace flyball {

// Whether or not it goes with them; nothing where none is found. What nothing slips in is searched for
// (SolveOptions::search), a short time where something rests in balance beside what is held; what slips is
// found by Newton-Raphson and what catches it alone (friction_search.hpp).
std::optional<StateOnFriction> solve_with_parts(const Mechanism& mechanism, const FrictionParts& parts,
                                                const SolveOptions& options);

// What is said of a state found with something that slips, in the place of "Converged.".
void tell_what_slips(StateOnFriction& state);

} // namespace flyball
