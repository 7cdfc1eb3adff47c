// What may be typed where a number is wanted.
#include "app/session/quantity.hpp"
#include "tests/catch.hpp"

#include <array>
#include <cmath>
#include <numbers>

using namespace flyball;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

struct Typed {
  const char *text, *unit;
  double value;
};

struct Refused {
  const char *text, *unit, *reason; // a part of the reason
};

} // namespace

TEST_CASE("numbers and expressions without a unit are in the field's unit") {
  const std::array typed{
      Typed{" 12.5 ", "rad/s", 12.5},
      Typed{"0.16/2", "m", 0.08},
      Typed{"1/3", "kg", 1.0 / 3},
      Typed{"-3", "m", -3},
      Typed{"+.5", "m", 0.5},
      Typed{"5.", "m", 5},
      Typed{"1e3", "N/m", 1000},
      Typed{"1.5E-3", "m", 0.0015},
      Typed{"2*(3+4)", "m", 14},
      Typed{"2 - 3 - 4", "m", -5},
      Typed{"16/4/2", "m", 2},
      Typed{"2^3", "", 8},
      Typed{"2 %", "%", 2},
      Typed{"1/4%", "%", 0.25},
      Typed{"2.5", "%", 2.5},
      Typed{"-2^2", "", -4},
      Typed{"2^-1", "", 0.5},
      Typed{"(1+1)^(1+2)", "", 8},
      Typed{"--2", "", 2},
      Typed{"pi/2", "rad", pi / 2},
      Typed{"2π", "rad/s", 2 * pi},
      Typed{"2 pi/4", "rad/s", pi / 2},
      Typed{"sqrt(2)/2", "", std::numbers::sqrt2 / 2},
      Typed{"abs(-3)", "m", 3},
      Typed{"0.2*cos(pi/3)", "m", 0.1},
      Typed{"3 − 1", "m", 2},
      Typed{"3×2", "m", 6},
      Typed{"90", "deg", 90},
      Typed{"10/4", "", 2.5},
  };
  for (const Typed& t : typed) {
    CAPTURE(t.text, t.unit);
    const Quantity quantity = parse_quantity(t.text, t.unit);
    CHECK(quantity.mistake == "");
    CHECK(quantity.value == Approx(t.value).epsilon(1e-14));
  }
}

TEST_CASE("units of the same kind are converted") {
  const std::array typed{
      // lengths
      Typed{"0.1 m", "m", 0.1},
      Typed{"100mm", "m", 0.1},
      Typed{"2.5 cm", "m", 0.025},
      Typed{"0.001 km", "m", 1},
      Typed{"250 um", "m", 250e-6},
      Typed{"250 µm", "m", 250e-6},
      Typed{"250 μm", "m", 250e-6},
      Typed{"2 in", "m", 0.0508},
      Typed{"1/2 in", "m", 0.0127},
      Typed{"2*1/2 in", "m", 0.0254},
      Typed{"3 ft", "m", 0.9144},
      Typed{"2*30 mm + 1 cm", "m", 0.07},
      Typed{"0.1 + 5 mm", "m", 0.105},
      Typed{"5 mm + 0.1", "m", 0.105},
      Typed{"(3 - 1) mm", "m", 0.002},
      Typed{"sqrt(4 cm^2)", "m", 0.02},
      Typed{"1 m * sin(30 deg)", "m", 0.5},
      Typed{"-40 mm", "m", -0.04},
      // angles
      Typed{"45 deg", "rad", 45 * degree},
      Typed{"45°", "rad", 45 * degree},
      Typed{"1/4 rev", "rad", pi / 2},
      Typed{"1/4 turn", "rad", pi / 2},
      Typed{"2 pi rad", "rad", 2 * pi},
      Typed{"20 mrad", "rad", 0.02},
      Typed{"pi rad", "rad", pi},
      Typed{"1 rad", "deg", 180 / pi},
      Typed{"90 + 45 deg", "deg", 135},
      Typed{"90 deg + 1", "rad", 90 * degree + 1},
      Typed{"atan(0.5)", "rad", std::atan(0.5)},
      Typed{"asin(1)", "deg", 90},
      Typed{"90 deg - acos(0.5)", "deg", 30},
      // speeds
      Typed{"300 rpm", "rad/s", 10 * pi},
      Typed{"300rpm/2", "rad/s", 5 * pi},
      Typed{"90 deg/s", "rad/s", pi / 2},
      Typed{"2 Hz", "rad/s", 4 * pi},
      Typed{"2 rev/min", "rad/s", pi / 15},
      Typed{"5/s", "rad/s", 5},
      Typed{"3 m/s", "m/s", 3},
      Typed{"36 km/h", "m/s", 10},
      Typed{"100 mm/s", "m/s", 0.1},
      Typed{"10 rad/s * 20 mm", "m/s", 0.2},
      // masses and inertia
      Typed{"500 g", "kg", 0.5},
      Typed{"1.2 t", "kg", 1200},
      Typed{"0.1 kg m^2", "kg m^2", 0.1},
      Typed{"500 g cm^2", "kg m^2", 5e-5},
      Typed{"500 g·cm²", "kg m^2", 5e-5},
      Typed{"10 kg*mm^2", "kg m^2", 1e-5},
      Typed{"2 kg * (0.1 m)^2", "kg m^2", 0.02},
      Typed{"1/12*2 kg*(30 cm)^2", "kg m^2", 0.015},
      Typed{"7.85 g/cm^3", "kg/m^3", 7850},
      Typed{"7850 kg/m³", "kg/m^3", 7850},
      // forces and what they are made of
      Typed{"2 kN", "N", 2000},
      Typed{"1 kg * 9.80665 m/s^2", "N", 9.80665},
      Typed{"1.5 mN", "N", 0.0015},
      Typed{"5 N m", "N m", 5},
      Typed{"5 Nm", "N m", 5},
      Typed{"5 N*m", "N m", 5},
      Typed{"5000 N mm", "N m", 5},
      Typed{"2 kN m", "N m", 2000},
      Typed{"2 kN/m", "N/m", 2000},
      Typed{"1 N/mm", "N/m", 1000},
      Typed{"10 N/2 mm", "N/m", 5000},
      Typed{"10 N m/rad", "N m/rad", 10},
      Typed{"10 N*m/rad", "N m/rad", 10},
      Typed{"10 Nm/rad", "N m/rad", 10},
      Typed{"10 N m", "N m/rad", 10},
      Typed{"1 N m/deg", "N m/rad", 1 / degree},
      Typed{"30 N s/m", "N s/m", 30},
      Typed{"30 Ns/m", "N s/m", 30},
      Typed{"30 N/(m/s)", "N s/m", 30},
      Typed{"2 N m s/rad", "N m s/rad", 2},
      Typed{"2 N m/(rad/s)", "N m s/rad", 2},
      Typed{"2 Nms/rad", "N m s/rad", 2},
      Typed{"0.02 N s^2/m^2", "N s^2/m^2", 0.02},
      Typed{"9.81 m/s^2", "m/s^2", 9.81},
      Typed{"981 cm/s²", "m/s^2", 9.81},
      Typed{"1.5 min", "s", 90},
      Typed{"20 ms", "s", 0.02},
      // a gear between an angle and a slide
      Typed{"2 mm/rev", "m/rad", 0.001 / pi},
      Typed{"0.5 m/rad", "m/rad", 0.5},
      Typed{"10 mm/5 mm", "", 2},
  };
  for (const Typed& t : typed) {
    CAPTURE(t.text, t.unit);
    const Quantity quantity = parse_quantity(t.text, t.unit);
    CHECK(quantity.mistake == "");
    CHECK(quantity.value == Approx(t.value).epsilon(1e-14));
  }
}

TEST_CASE("what cannot be understood is refused with the reason") {
  const std::array refused{
      Refused{"2 mm", "%", "Expected a plain number"},
      Refused{"", "m", "Nothing was typed"},
      Refused{"   ", "m", "Nothing was typed"},
      Refused{"12 kg", "m", "Expected a length, e.g. 0.1 m or 100 mm"},
      Refused{"12 m", "rad/s", "Expected a speed of turning"},
      Refused{"45 deg", "", "Expected a plain number"},
      Refused{"45 deg", "m", "Expected a length"},
      Refused{"10 N m/rad", "N m", "Expected a torque"},
      Refused{"10 m^2", "m", "Expected a length"},
      Refused{"5 1/s", "rad/s", "missing before"},
      Refused{"2 (3 - 1) m", "m", "missing before"},
      Refused{"0,16", "m", "write 0.5, not 0,5"},
      Refused{"1,000.5", "m", "comma"},
      Refused{"fast", "rad/s", "“fast” is no unit"},
      Refused{"nan", "kg", "Expected a finite number."},
      Refused{"inf", "rad/s", "Expected a finite number."},
      Refused{"3 furlongs", "m", "“furlongs” is no unit"},
      Refused{"3 Kg", "kg", "did you mean \"kg\""},
      Refused{"3 €", "m", "“€” is no unit"},
      Refused{"1/0", "m", "no finite number"},
      Refused{"0/0", "m", "no finite number"},
      Refused{"1e999", "m", "no finite number"},
      Refused{"1e-400 mm", "m", "smaller than 1e-307"},
      Refused{"sqrt(-1)", "m", "no finite number"},
      Refused{"2 m + 3 kg", "m", "A sum of a length and a mass"},
      Refused{"2 + 3 mm", "kg", "A sum of a plain number and a length"},
      Refused{"2^(3 m)", "", "An exponent has no unit"},
      Refused{"(2 m)^0.5", "m", "That power of a unit"},
      Refused{"sqrt(2 m)", "m", "That power of a unit"},
      Refused{"sin(2 m)", "", "sin is of an angle"},
      Refused{"asin(2 m)", "rad", "asin is of a plain number"},
      Refused{"sin 3", "", "comes a parenthesis"},
      Refused{"(1 + 2", "m", "not closed"},
      Refused{"1 + 2)", "m", "“)” cannot stand there"},
      Refused{"1 +", "m", "missing at the end"},
      Refused{"1 2", "m", "missing before “2”"},
      Refused{"1.2.3", "m", "missing before “.3”"},
      Refused{"2 m 3", "m", "missing before “3”"},
      Refused{".", "m", "cannot stand there"},
      Refused{"*2", "m", "“*” cannot stand there"},
      Refused{"2 m^x", "m", "whole number"},
      Refused{"#", "m", "“#” cannot stand there"},
  };
  for (const Refused& r : refused) {
    CAPTURE(r.text, r.unit);
    const Quantity quantity = parse_quantity(r.text, r.unit);
    CHECK_FALSE(quantity);
    CHECK_THAT(quantity.mistake, ContainsSubstring(r.reason));
    CHECK(quantity.mistake.find("?.") == std::string::npos);
  }
  // No stack is deep enough for everything that can be pasted.
  const std::string deep = std::string(100000, '(') + "1" + std::string(100000, ')');
  CHECK_FALSE(parse_quantity(deep, "m"));
  CHECK_FALSE(parse_quantity(std::string(100000, '-') + "1", "m"));
}

TEST_CASE("every unit that fields have is understood as typed") {
  for (const char* unit :
       {"m", "rad", "deg", "rad/s",   "m/s",   "m/s^2",     "s",         "kg",    "kg m^2", "kg/m^3",
        "N", "N m", "N/m", "N m/rad", "N s/m", "N m s/rad", "N s^2/m^2", "m/rad", "rad/m",  ""}) {
    CAPTURE(unit);
    const Quantity quantity = parse_quantity(std::string("-1.25e-3 ") + unit, unit);
    CHECK(quantity.mistake == "");
    CHECK(quantity.value == -1.25e-3);
  }
}
