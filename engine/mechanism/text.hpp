// Small helpers for messages that help.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flyball {

// The shortest text that reads back as exactly this number.
std::string number_text(double value);

// At most `digits` significant digits: for a sentence, not for reading back.
std::string rounded_text(double value, int digits);

// What a coordinate is called in results, tables and options: "swing", or "ball.3" where the joint has
// several.
std::string coordinate_label(const std::string& joint, int index, int count);
// Of anything with these three.
template <class Coordinate>
std::string coordinate_label(const Coordinate& c) {
  return coordinate_label(c.joint, c.index, c.count);
}

// A text cell of a CSV table (RFC 4180); what would be a formula gets an apostrophe before it
// (safe_text.hpp).
std::string csv_field(std::string_view text);

// The candidate a person most likely meant by `word`, or "" where none is close.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);
// `; did you mean "axis"?`, or "" where nothing is close.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

// "a, b or c"; shortened with "..." where there are many.
std::string word_list(std::span<const std::string_view> words, std::string_view conjunction = "or");

// Where the first byte stands that is not UTF-8, or npos.
std::size_t find_invalid_utf8(std::string_view text);

} // namespace flyball
