// A number with its unit that is typed while the hand is at work in the view, without a field: how far, how
// long, how large.
#pragma once

#include "app/session/units.hpp"
#include "app/ui/ui.hpp"

#include <string>

namespace flyball {

// Takes a key that goes on with what is typed: digits, a sign or a point begin it, letters of a unit, blanks
// and sums follow, Backspace takes the last one away. False where the key is not of it.
bool take_typed_key(std::string& typed, const KeyPress& key);

// As it is shown: "1.5_ m", or "150 mm_" once there is a unit in it.
std::string typed_text(const std::string& typed, const std::string& unit);

// What is typed as a length (m, more than zero; a number without a unit in the one shown); nothing where it
// is none, and then why, as a sentence.
std::optional<double> typed_length(const std::string& typed, const DisplayUnits& units, std::string* mistake);

} // namespace flyball
