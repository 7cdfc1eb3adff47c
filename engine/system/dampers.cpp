#include "engine/system/dampers.hpp"

#include <algorithm>

namespace flyball {

bool has_dampers(const Parameters& parameters) {
  return std::ranges::any_of(parameters.cut_dampers, &CutDamperParameters::damped) ||
         std::ranges::any_of(parameters.bearings,
                             [](const BearingParameters& b) { return !b.damping.isZero(0); }) ||
         std::ranges::any_of(parameters.links,
                             [](const LinkParameters& link) {
                               return std::ranges::any_of(link.force, &CoordinateForce::damped);
                             }) ||
         std::ranges::any_of(parameters.springs, &PointSpringParameters::damped);
}

bool is_hamiltonian(const System& system, const Parameters& parameters) {
  return system.conservative && !has_dampers(parameters);
}

} // namespace flyball
