// Small helpers for messages that help.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flyball {

// The shortest text that reads back as exactly this number.
std::string number_text(double value);

// The candidate a person most likely meant by `word`, or "" where none is close.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);
// `; did you mean "axis"?`, or "" where nothing is close.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

// "a, b or c"; shortened with "..." where there are many.
std::string word_list(std::span<const std::string_view> words, std::string_view conjunction = "or");

// Where the first byte stands that is not UTF-8, or npos.
std::size_t find_invalid_utf8(std::string_view text);

} // namespace flyball
