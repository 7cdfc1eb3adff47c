#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

// After an edit of `before` that has set numbers which expressions give: the numbers that these rest on are
// changed so that it is so, where they are determined by it (dragging a joint that stands at a point moves
// the point, and all else that stands there). Parts that are new keep their expressions where these mean
// the same, as copies do that stand at the same place. Expressions are evaluated. Throws SceneError that
// says what gives the number where it cannot be so; where expressions had mistakes before, only if there are
// more of them now.
void settle_formulas(const Mechanism& before, Mechanism& next);

} // namespace flyball
