// Units that can be typed, and dimensions to tell a length from a mass.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace flyball {

// Exponents. The angle counts as one of its own, so that a speed of turning is no frequency of zero turns.
struct Dimension {
  int length = 0, mass = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
  bool none() const { return *this == Dimension{}; }
};

// What a coordinate is shown in: ° or mm; and what SI values are multiplied by.
const char* screen_unit(bool angle);
double screen_factor(bool angle);

Dimension operator+(const Dimension& a, const Dimension& b); // of a product
Dimension operator*(const Dimension& a, int power);

struct Unit {
  std::string_view name;
  double factor = 1; // in SI units and radians
  Dimension dimension;
};

std::optional<Unit> find_unit(std::string_view name);
std::span<const std::string_view> unit_names();

} // namespace flyball
