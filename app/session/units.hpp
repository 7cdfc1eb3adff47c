// The units that numbers are shown in.
#pragma once

#include "engine/mechanism/unit.hpp"

#include <string>
#include <string_view>

namespace flyball {

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
