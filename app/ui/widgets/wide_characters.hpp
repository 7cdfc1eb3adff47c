// Characters beyond 16 bits, as emoji are, in fields of a Dear ImGui that has 16: it would put U+FFFD in
// their place and keep what was behind them wrong. Stand-ins of the private use area go through the field
// instead.
#pragma once

#include <string>
#include <vector>

namespace flyball {

// The characters that stand-ins stand for, in the order in which they were met.
using WideCharacters = std::vector<std::string>;

// Puts stand-ins into the text, which is UTF-8.
void put_stand_ins(std::string& text, WideCharacters& characters);
// Puts the characters back.
void take_stand_ins(std::string& text, const WideCharacters& characters);

} // namespace flyball
