// Whether a mechanism means something, beyond being well-formed.
#pragma once

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <vector>

namespace flyball {

// The mistakes, in three rounds, of which a later one makes sense only where the earlier finds none: names
// and numbers that are none; single parts, in order of appearance; the mechanism as a whole. Empty when it
// can be compiled and solved.
std::vector<SceneError> find_mistakes(const Mechanism& mechanism);
// The same of a mechanism that had none before the number at `address` was set: where that is right in its
// part, the others are not looked at again.
std::vector<SceneError> find_mistakes(const Mechanism& mechanism, std::string_view address);
// Throws the first of them.
void validate(const Mechanism& mechanism);
// The same of a mechanism that had none before numbers of it were set, and what expressions make of them: a
// tenth of the work.
void validate_numbers(const Mechanism& mechanism);

// What is solved as it stands but is no real mechanism's, and so most likely a slip: one sentence each, with
// its path as in SceneError. For a mechanism without mistakes.
std::vector<SceneError> find_warnings(const Mechanism& mechanism);

} // namespace flyball
