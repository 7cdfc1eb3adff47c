#include "engine/mechanism/fields.hpp"

#include <array>

namespace flyball::fields {

GearUnits gear_units(const Mechanism& mechanism, const Joint& gear) {
  enum class Measure { unknown, angle, length };
  const auto measure = [&](const std::string& end) {
    const auto [joint, i] = find_coordinate(mechanism, end);
    if (joint < 0) return Measure::unknown;
    return is_angle(mechanism.joints[static_cast<std::size_t>(joint)].type, i) ? Measure::angle
                                                                               : Measure::length;
  };
  const Measure a = measure(gear.joints[0]), b = measure(gear.joints[1]);
  if (b == Measure::unknown) return {};
  const std::string_view offset = value_unit(b == Measure::angle);
  if (a == Measure::unknown || a == b) return {"", offset};
  return {b == Measure::angle ? "rad/m" : "m/rad", offset};
}

std::string_view bearing_unit(std::string_view of, std::size_t size, std::size_t row, std::size_t column) {
  if (size == 2) return of;
  constexpr std::array<std::string_view, 4> by_shift{"N/m", "N", "N m/m", "N m/rad"},
      by_rate{"N s/m", "N s", "N m s/m", "N m s/rad"};
  const std::size_t quantity = (row < 3 ? 0U : 2U) + (column < 3 ? 0U : 1U);
  return of == by_shift[0] ? by_shift[quantity] : by_rate[quantity];
}

Vec3 mass_centre(const Mechanism& mechanism, std::string_view body) {
  const int index = body_index(mechanism, body);
  return index < 0 ? Vec3(Vec3::Zero()) : mechanism.bodies[static_cast<std::size_t>(index)].position;
}

} // namespace flyball::fields
