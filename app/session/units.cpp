#include "app/session/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace flyball {

namespace {

constexpr double degree = std::numbers::pi / 180, revolution = 2 * std::numbers::pi;
constexpr Dimension length{.length = 1}, angle{.angle = 1}, time{.time = 1}, mass{.mass = 1},
    turning{.time = -1, .angle = 1}, force{.length = 1, .mass = 1, .time = -2},
    torque{.length = 2, .mass = 1, .time = -2};

constexpr std::array units{
    Unit{"m", 1, length},
    Unit{"mm", 1e-3, length},
    Unit{"cm", 1e-2, length},
    Unit{"km", 1e3, length},
    Unit{"um", 1e-6, length},
    Unit{"µm", 1e-6, length},
    Unit{"in", 0.0254, length},
    Unit{"ft", 0.3048, length},
    Unit{"rad", 1, angle},
    Unit{"mrad", 1e-3, angle},
    Unit{"deg", degree, angle},
    Unit{"°", degree, angle},
    Unit{"rev", revolution, angle},
    Unit{"s", 1, time},
    Unit{"ms", 1e-3, time},
    Unit{"min", 60, time},
    Unit{"h", 3600, time},
    Unit{"Hz", revolution, turning}, // one turn a second
    Unit{"rpm", revolution / 60, turning},
    Unit{"kg", 1, mass},
    Unit{"g", 1e-3, mass},
    Unit{"mg", 1e-6, mass},
    Unit{"t", 1e3, mass},
    Unit{"N", 1, force},
    Unit{"mN", 1e-3, force},
    Unit{"kN", 1e3, force},
    Unit{"MN", 1e6, force},
    // As many write them in one word.
    Unit{"Nm", 1, torque},
    Unit{"kNm", 1e3, torque},
    Unit{"mNm", 1e-3, torque},
    Unit{"Nmm", 1e-3, torque},
    Unit{"Ncm", 1e-2, torque},
    Unit{"Ns", 1, {.length = 1, .mass = 1, .time = -1}},
    Unit{"Nms", 1, {.length = 2, .mass = 1, .time = -1}},
};

constexpr auto names = [] {
  std::array<std::string_view, units.size()> all{};
  std::ranges::transform(units, all.begin(), &Unit::name);
  return all;
}();

} // namespace

Dimension operator+(const Dimension& a, const Dimension& b) {
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.angle + b.angle};
}

Dimension operator*(const Dimension& a, int power) {
  return {a.length * power, a.mass * power, a.time * power, a.angle * power};
}

std::optional<Unit> find_unit(std::string_view name) {
  const auto found = std::ranges::find(units, name, &Unit::name);
  return found == units.end() ? std::nullopt : std::optional(*found);
}

std::span<const std::string_view> unit_names() {
  return names;
}

double times_unit(double number, double unit) {
  const double parts = std::round(1 / unit);
  const bool whole = unit < 1 && std::abs(1 / unit - parts) <= 1e-12 * parts;
  if (!whole) return number * unit;
  // 5.1 mm is 0.0051 m and not the neighbour that rounding twice may give.
  const double quotient = number / parts;
  const double tidy = std::strtod(fmt::format("{:.15g}", quotient).c_str(), nullptr);
  return std::abs(tidy - quotient) <= 4e-16 * std::abs(quotient) ? tidy : quotient;
}

double ShownUnit::si(double shown) const {
  return times_unit(shown, inverse);
}

double ShownUnit::shown(double value) const {
  if (factor == 1) return value;
  const double product = value * factor;
  const double tidy = std::strtod(fmt::format("{:.15g}", product).c_str(), nullptr);
  return std::abs(si(tidy) - value) <= 4e-16 * std::abs(value) ? tidy : product;
}

std::string written_unit(std::string_view unit) {
  std::string written;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::string_view power = unit.substr(i, 2);
    if (power == "^2" || power == "^3") {
      written += power == "^2" ? "²" : "³";
      ++i;
    } else {
      written += unit[i];
    }
  }
  return written;
}

ShownUnit shown_unit(std::string_view si, const DisplayUnits& units) {
  const bool mm = units.length == LengthUnit::millimetre;
  if (si == "m" && mm) return {"mm", 1e3, 1e-3};
  if (si == "m/s" && mm) return {"mm/s", 1e3, 1e-3};
  if (si == "N/m" && mm) return {"N/mm", 1e-3, 1e3};
  if (si == "N s/m" && mm) return {"N s/mm", 1e-3, 1e3};
  if (si == "deg")
    return units.angle == AngleUnit::degree ? ShownUnit{"°", 1, 1} : ShownUnit{"rad", degree, 1 / degree};
  if (si == "rad" && units.angle == AngleUnit::degree) return {"°", 1 / degree, degree};
  if (si == "rad/s" && units.speed == SpeedUnit::degree) return {"°/s", 1 / degree, degree};
  if (si == "rad/s" && units.speed == SpeedUnit::rpm) return {"rpm", 60 / revolution, revolution / 60};
  return {written_unit(si), 1, 1};
}

ShownUnit coordinate_unit(bool angle, const DisplayUnits& units) {
  return shown_unit(angle ? "rad" : "m", units);
}

ShownUnit rate_unit(bool angle, const DisplayUnits& units) {
  return shown_unit(angle ? "rad/s" : "m/s", units);
}

} // namespace flyball
