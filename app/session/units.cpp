#include "app/session/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace flyball {

namespace {

constexpr double degree = std::numbers::pi / 180, revolution = 2 * std::numbers::pi;

} // namespace

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
