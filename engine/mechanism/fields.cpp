#include "engine/mechanism/fields.hpp"

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

Vec3 mass_centre(const Mechanism& mechanism, std::string_view body) {
  const int index = body_index(mechanism, body);
  return index < 0 ? Vec3(Vec3::Zero()) : mechanism.bodies[static_cast<std::size_t>(index)].position;
}

} // namespace flyball::fields
