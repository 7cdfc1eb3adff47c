// Stability on kinks of laws, where the linearised motion has a side on either hand.
#pragma once

#include "engine/stability/stability.hpp"

namespace flyball {

// Notes the kinks on which the state stands, and leaves of the verdict in `out`, which takes the slopes of
// all laws as they are evaluated, what the sides have in common.
void judge_kinks(const FactoredState& at, Stability& out);

} // namespace flyball
