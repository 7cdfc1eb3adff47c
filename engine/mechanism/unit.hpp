// Units as texts: "mm", "N/m", "kg m^2", "rpm".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace flyball {

// Exponents of the base units. An angle is a number, as in the SI: an arc is radius times angle.
struct Dimension {
  double metre = 0, kilogram = 0, second = 0;
  bool operator==(const Dimension&) const = default;
  friend Dimension operator+(const Dimension& a, const Dimension& b) {
    return {a.metre + b.metre, a.kilogram + b.kilogram, a.second + b.second};
  }
  friend Dimension operator*(double n, const Dimension& a) {
    return {n * a.metre, n * a.kilogram, n * a.second};
  }
};

struct Unit {
  double factor = 1; // one of it in SI units
  Dimension dimension;
};

// Units with exponents, divided and multiplied: "N", "kg m^2", "N m s/rad", "rev/min"; a slash divides by what
// follows it up to the next blank. Nothing for any other text; the empty one is the unit 1.
std::optional<Unit> parse_unit(std::string_view text);

// The longest unit at the beginning of a text, without which the rest goes on; nothing where it begins
// with none.
struct UnitPrefix {
  Unit unit;
  std::size_t length = 0;
};
std::optional<UnitPrefix> read_unit(std::string_view text);

// As a person calls it: "m", "N/m", "kg m^2/s^3"; "a number" without dimension.
std::string dimension_text(const Dimension& dimension);

} // namespace flyball
