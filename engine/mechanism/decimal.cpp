#include "engine/mechanism/decimal.hpp"

#ifndef __cpp_lib_to_chars
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <locale.h>
#include <string>
#endif

namespace flyball {

#ifdef __cpp_lib_to_chars

std::from_chars_result read_decimal(const char* first, const char* last, double& value) {
  return std::from_chars(first, last, value);
}

#else

namespace {

const char* after_figures(const char* at, const char* last) {
  return std::find_if(at, last, [](char c) { return c < '0' || c > '9'; });
}

// Where a number that begins at `first` ends; `first` where none does. strtod would read on: into 0x, or into
// a unit.
const char* end_of_decimal(const char* first, const char* last) {
  const char* at = first != last && *first == '-' ? first + 1 : first;
  const std::string_view rest(at, static_cast<std::size_t>(last - at));
  if (rest.starts_with("inf") || rest.starts_with("nan")) return at + 3;
  const char* whole = after_figures(at, last);
  const bool point = whole != last && *whole == '.';
  const char* end = point ? after_figures(whole + 1, last) : whole;
  if (end - at == (point ? 1 : 0)) return first;
  if (end == last || (*end != 'e' && *end != 'E')) return end;
  const char* exponent = end + 1;
  if (exponent != last && (*exponent == '+' || *exponent == '-')) ++exponent;
  const char* figures = after_figures(exponent, last);
  return figures == exponent ? end : figures;
}

} // namespace

std::from_chars_result read_decimal(const char* first, const char* last, double& value) {
  const char* end = end_of_decimal(first, last);
  if (end == first) return {first, std::errc::invalid_argument};
  static const locale_t decimal_point = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string text(first, end);
  const double read = strtod_l(text.c_str(), nullptr, decimal_point);
  const bool infinite = std::isinf(read) && text.find("inf") == std::string::npos;
  const bool lost = read == 0 && text.find_first_of("123456789") < text.find_first_of("eE");
  if (infinite || lost) return {end, std::errc::result_out_of_range};
  value = read;
  return {end, std::errc()};
}

#endif

} // namespace flyball
