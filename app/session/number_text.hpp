// Numbers as a person reads them: no more digits than are known.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace flyball {

struct NumberStyle {
  int most_digits = 12; // significant
  // Below this a number is round-off and told as "< 1e-16": computers differ in it. Pictures that are to come
  // out the same everywhere raise it, and leave out run times.
  double noise = 1e-16;
  bool run_times = true;
};

// The value down to the decimal place in which the error has its first digit. An error that is zero or not
// finite says nothing: most_digits then.
std::string value_text(double value, double error, const NumberStyle& style);
// A magnitude: two digits, "3.1e-14"; below the noise "< 1e-16".
std::string magnitude_text(double value, const NumberStyle& style);
// The same, but written out from a thousandth to ten thousand: "0.036".
std::string size_text(double value, const NumberStyle& style);
// At most `digits` significant digits, without trailing zeros.
std::string short_text(double value, int digits = 6);
// Three significant digits, written out up to a million: "1290", "0.0123".
std::string rough_text(double value);
// "2.4 µs", "13 ms", "1.2 s".
std::string duration_text(double seconds, const NumberStyle& style);

// Where the number begins and ends that a person means who points at byte `at` of a typed quantity: the one
// there, else the one whose unit is there. "2 m" has its 2 at [0, 1). Empty where there is no number.
std::pair<std::size_t, std::size_t> number_at(std::string_view text, std::size_t at);

} // namespace flyball
