// Reading a decimal number, whatever the locale.
#pragma once

#include <charconv>

namespace flyball {

// As std::from_chars reads a double, which libc++ has not had before version 20: "-12.5e-3", "inf" and "nan",
// without a sign + or blanks before it. `ptr` of the result is where the number ends, and `ec`
// std::errc::result_out_of_range where no double is as large or as small; then, as where there is no number
// (std::errc::invalid_argument), `value` stays as it is.
std::from_chars_result read_decimal(const char* first, const char* last, double& value);

} // namespace flyball
