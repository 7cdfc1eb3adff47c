// What the word that is being typed in an expression could become: names of the mechanism and functions.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct Completion {
  std::string text;  // in the place of the word: "gain", "distance("
  std::string words; // what it is: "0.3 m", "distance(ball, ground@A)"
};

struct Completions {
  std::size_t from = 0, to = 0; // bytes of the word, of which nothing may be typed yet
  std::vector<Completion> list; // the word itself first, where it is one of them
};

// Of the word that ends at the cursor (bytes): names that begin as it does, upper and lower case alike.
// Between the brackets of a function the parts that it asks for come first. Nothing inside numbers and units.
Completions completions_at(const Mechanism& mechanism, std::string_view text, std::size_t cursor);

} // namespace flyball
