// How well a name, or a text, answers what somebody types to find it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct FuzzyMatch {
  int score = -1;                 // the higher the better; negative: it does not answer
  std::vector<std::size_t> marks; // the bytes of the name that were typed, ascending
  explicit operator bool() const { return score >= 0; }
};

// Every word that is typed has to be found: in `name` together, at best as a word of it, then at the
// beginning of one, or spread over it from a word's beginning on ("sos" in "speed of spin"), or in `more`,
// which is not shown, together. Upper and lower case count as the same. Nothing typed answers everything,
// with 0.
FuzzyMatch fuzzy_match(std::string_view typed, std::string_view name, std::string_view more = {});

// Whether every word that is typed begins a word of the text, or continues it behind a sign: "bar" is in
// "four-bar". Upper and lower case count as the same.
bool words_begin(std::string_view typed, std::string_view text);

} // namespace flyball
