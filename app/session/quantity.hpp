// What a person types where a number is wanted: an expression, with units.
//
// Understood are + - * / ^, parentheses, sqrt, sin, cos, tan, asin, acos, atan, abs, pi, and units with their
// powers, products and quotients ("N m/rad", "g/cm^3"). A number without a unit is in the field's unit, in a
// sum too: "0.1 + 5 mm". A unit after a fraction belongs to all of it: "1/2 in". Radians may be left out
// ("1/s" for rad/s, "N m" for N m/rad), but an angle is no plain number.
#pragma once

#include <string>
#include <string_view>

namespace flyball {

struct Quantity {
  double value = 0;    // in the field's unit
  std::string mistake; // why there is no value, a sentence; empty where there is one
  explicit operator bool() const { return mistake.empty(); }
};

// `unit` is the field's ("rad/s", "kg m^2", "%", "" for a plain number). The value is finite.
Quantity parse_quantity(std::string_view text, std::string_view unit);
// The same of a field that is shown in another unit than its value has: a plain number is in `shown`.
Quantity parse_quantity(std::string_view text, std::string_view unit, std::string_view shown);

// Signs that look alike or are nicer than those on a keyboard ("m²", "·", "π") as these.
std::string plain_signs(std::string_view text);

// "a length, e.g. 0.1 m or 100 mm": what a field of this unit expects.
std::string expected_quantity(std::string_view unit);

} // namespace flyball
