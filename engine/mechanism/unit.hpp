// Units as texts: "mm", "N/m", "kg m^2", "rpm"; and dimensions, to tell a length from a mass.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace flyball {

// Exponents. The angle counts as one of its own, so that whoever cares can tell a speed of turning from a
// frequency.
struct Dimension {
  double length = 0, mass = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
  bool none() const { return *this == Dimension{}; }
  // As the SI has it, an angle being a number: an arc is radius times angle.
  Dimension without_angle() const { return {length, mass, time, 0}; }
};

constexpr Dimension operator+(const Dimension& a, const Dimension& b) { // of a product
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.angle + b.angle};
}
constexpr Dimension operator*(const Dimension& a, double power) {
  return {a.length * power, a.mass * power, a.time * power, a.angle * power};
}

struct Unit {
  std::string_view name;
  double factor = 1; // one of it in SI units and radians
  Dimension dimension;
};

// One symbol: "mm".
std::optional<Unit> find_unit(std::string_view name);
std::span<const std::string_view> unit_names();

// `number` of a unit of so many SI units; divided where the unit is a whole part of one, so that 3 mm is the
// number nearest to 0.003.
double times_unit(double number, double unit);

// Symbols with exponents, divided and multiplied: "N", "kg m^2", "N m s/rad", "rev/min"; a slash divides by
// the symbol behind it. Nothing for any other text; the empty one is the unit 1. Without a name.
std::optional<Unit> parse_unit(std::string_view text);

// The longest unit at the beginning of a text, without which the rest goes on; nothing where it begins
// with none.
struct UnitPrefix {
  Unit unit;
  std::size_t length = 0;
};
std::optional<UnitPrefix> read_unit(std::string_view text);

// As a person calls it, an angle being a number: "m", "N/m", "kg m^2/s^3"; "a number" without dimension.
std::string dimension_text(const Dimension& dimension);

} // namespace flyball
