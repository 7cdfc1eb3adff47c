#include "engine/mechanism/prescribed_speeds.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace flyball {

std::vector<PrescribedSpeed> prescribed_speeds(const Mechanism& mechanism) {
  std::vector<PrescribedSpeed> speeds;
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      if (const auto& drive = joint.coordinates[i].drive; drive && !finds_speed(*drive))
        speeds.push_back({joint.name, drive_speed_address(joint, i), drive->speed,
                          is_angle(joint.type, static_cast<int>(i))});
  return speeds;
}

std::string number_alone(const Mechanism& mechanism, std::string_view address) {
  std::string at(address);
  // No longer way leads from parameter to parameter but in a circle, which is a mistake of the scene.
  for (std::size_t steps = 0; steps <= mechanism.parameters.size(); ++steps) {
    std::optional<std::string> formula = formula_at(mechanism, at);
    if (!formula) return at;
    std::erase(*formula, ' ');
    if (parameter_index(mechanism, *formula) < 0) break;
    at = "parameters." + *formula;
  }
  return {};
}

bool sets_speed(const Mechanism& mechanism, std::string_view address) {
  return std::ranges::any_of(prescribed_speeds(mechanism), [&](const PrescribedSpeed& speed) {
    if (speed.address == address) return true;
    const std::optional<std::string> formula = formula_at(mechanism, speed.address);
    if (!formula) return false;
    const std::vector<std::string> sources = sources_of(mechanism, *formula);
    return std::ranges::find(sources, address) != sources.end();
  });
}

} // namespace flyball
