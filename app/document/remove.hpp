// Taking parts out, with whatever cannot be without them.
#pragma once

#include "app/document/part.hpp"

namespace flyball {

// The selection with all that hangs on it: joints and forces of its bodies, gears of its joints.
Selection with_dependents(const Mechanism& mechanism, const Selection& selection);
// Removes these and their dependents, and sliders of what is gone.
void remove_parts(Mechanism& mechanism, const Selection& selection);

} // namespace flyball
