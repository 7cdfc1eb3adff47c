#include "engine/mechanism/frictions.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/referred_to.hpp"

#include <algorithm>

namespace flyball {
namespace {

// All whose speeds drives give, themselves or through gears: each gear train is walked once.
std::vector<CoordinateReference> find_given_speeds(const Mechanism& mechanism) {
  std::vector<CoordinateReference> given;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i) {
      const CoordinateReference at{static_cast<int>(j), static_cast<int>(i)};
      const auto& drive = mechanism.joints[j].coordinates[i].drive;
      if (!drive || finds_speed(*drive) || std::ranges::count(given, at)) continue;
      for (const GearedCoordinate& geared : gear_train(mechanism, at))
        given.push_back(geared.at);
    }
  return given;
}

} // namespace

bool rubs_anywhere(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints, [](const Joint& joint) {
    return std::ranges::any_of(joint.coordinates, [](const Coordinate& c) { return c.friction.has_value(); });
  });
}

std::vector<CoordinateReference> find_frictions(const Mechanism& mechanism) {
  std::vector<CoordinateReference> all;
  if (!rubs_anywhere(mechanism)) return all;
  const std::vector<CoordinateReference> given = find_given_speeds(mechanism);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i)
      if (const CoordinateReference at{static_cast<int>(j), static_cast<int>(i)};
          mechanism.joints[j].coordinates[i].friction && !std::ranges::count(given, at))
        all.push_back(at);
  return all;
}

bool has_friction(const Mechanism& mechanism) {
  return !find_frictions(mechanism).empty();
}

bool is_at_given_speed(const Mechanism& mechanism, CoordinateReference at) {
  return std::ranges::count(find_given_speeds(mechanism), at) > 0;
}

const Friction& friction_at(const Mechanism& mechanism, CoordinateReference at) {
  return *coordinate_of(mechanism, at).friction;
}

std::string share_address(const Mechanism& mechanism, CoordinateReference at) {
  const Joint& joint = joint_of(mechanism, at);
  return "joints." + joint.name + "." +
         coordinate_key(joint, static_cast<std::size_t>(at.coordinate), "friction") + ".share";
}

} // namespace flyball
