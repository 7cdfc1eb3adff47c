#include "engine/system/dampers.hpp"

#include <algorithm>

namespace flyball {

bool has_dampers(const System& system, const Parameters& parameters) {
  return !system.cut_dampers.empty() || std::ranges::any_of(parameters.links, [](const LinkParameters& link) {
    return std::ranges::any_of(link.force, &CoordinateForce::damped);
  }) || std::ranges::any_of(parameters.springs, &PointSpringParameters::damped);
}

bool is_hamiltonian(const System& system, const Parameters& parameters) {
  return system.conservative && system.bearings.empty() && !has_dampers(system, parameters);
}

} // namespace flyball
