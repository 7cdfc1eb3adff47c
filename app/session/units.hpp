// Units that can be typed, those that numbers are shown in, and dimensions to tell a length from a mass.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace flyball {

// Exponents. The angle counts as one of its own, so that a speed of turning is no frequency of zero turns.
struct Dimension {
  int length = 0, mass = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
  bool none() const { return *this == Dimension{}; }
};

Dimension operator+(const Dimension& a, const Dimension& b); // of a product
Dimension operator*(const Dimension& a, int power);

struct Unit {
  std::string_view name;
  double factor = 1; // in SI units and radians
  Dimension dimension;
};

std::optional<Unit> find_unit(std::string_view name);
std::span<const std::string_view> unit_names();

// `number` of a unit of so many SI units; divided where the unit is a whole part of one, so that 3 mm is the
// number nearest to 0.003.
double times_unit(double number, double unit);

// What fields, results and plots show numbers in, as a person has chosen. Stiffness, damping and speeds along
// a line go with the length. Files and CSV stay in SI units and radians.
enum class AngleUnit { degree, radian };
enum class LengthUnit { metre, millimetre };
enum class SpeedUnit { radian, degree, rpm }; // of turning: rad/s, °/s, 1/min
struct DisplayUnits {
  AngleUnit angle = AngleUnit::degree;
  LengthUnit length = LengthUnit::metre;
  SpeedUnit speed = SpeedUnit::radian;
  bool operator==(const DisplayUnits&) const = default;
};

// A unit on the screen, and how many of it the SI unit is.
struct ShownUnit {
  std::string text; // as it can be typed, too: "°", "N/mm", "m/s²"
  double factor = 1;
  double inverse = 1;

  double shown(double si) const; // without the last digit's dust, so that a typed 1.1 mm is shown so
  double si(double shown) const;
};

// The unit with powers set high: "m/s²" for m/s^2.
std::string written_unit(std::string_view unit);

// For numbers in the unit `si` ("rad/s", "N/m"), which is also what it is where there is no choice.
ShownUnit shown_unit(std::string_view si, const DisplayUnits& units);
// For a coordinate, and for its rate.
ShownUnit coordinate_unit(bool angle, const DisplayUnits& units);
ShownUnit rate_unit(bool angle, const DisplayUnits& units);

} // namespace flyball
