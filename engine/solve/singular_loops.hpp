// Poses in which the loops lose an equation.
#pragma once

#include "engine/solve/newton.hpp"

#include <optional>
#include <span>

namespace flyball {

// Whether more of the loops' equations are independent beside the state than in it, as nearly as the state is
// known: arms straight, a linkage flat. There lengths change with the square of the angles, tangents lead off
// the loops, and the linearised motion along them is none of the mechanism's. Of a state that is evaluated
// and factored in the workspace; of large loops, which are factored as sparse ones, it is not known: false.
bool at_singular_loops(const Problem& problem, const Unknowns& z, Workspace& w);

// Whether a mechanism goes through such a pose, or is so near to it that rounding decides, without being in
// balance there, as a parallelogram that is flat: what acts is balanced by multipliers alone that grow
// without bounds, of equations that the loops lose. False where they hold it all the same, as two rods that
// are straight between fixed points. Of a state that Newton-Raphson arrived at; uses the workspace beside its
// own.
bool passes_singular_loops(const Problem& problem, const Unknowns& z, Workspace& w);

// The first of these cut joints (in System::cuts) whose loop is drawn in such a pose, a change point, or so
// near to it that rounding decides: there it does not tell at which rates it turns with what drives it. Of a
// mechanism as compile_for_drives() compiles it; of a loop of many coordinates it is not known, and it
// is none. Gears are in no such pose. Throws Interrupted.
std::optional<int> find_change_point(const Mechanism& mechanism, const System& system,
                                     std::span<const int> cuts);

} // namespace flyball
