// Whether a mechanism means something, beyond being well-formed.
#pragma once

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <vector>

namespace flyball {

// Every mistake in the mechanism, in order of appearance; empty when it can be compiled and solved.
std::vector<SceneError> find_mistakes(const Mechanism& mechanism);
// Throws the first of them.
void validate(const Mechanism& mechanism);

} // namespace flyball
