#include "engine/report/friction_parts.hpp"

#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

using Part = FrictionPart;

} // namespace

FrictionParts parts_of(const Mechanism& mechanism, std::span<const FrictionForce> frictions) {
  const std::vector<CoordinateReference> all = find_frictions(mechanism);
  FrictionParts out(all.size(), Part::none);
  for (const FrictionForce& force : frictions) {
    const auto at = std::ranges::find(all, find_coordinate(mechanism, coordinate_label(force)));
    if (at == all.end()) continue;
    out[static_cast<std::size_t>(at - all.begin())] = !force.slips                 ? Part::holds
                                                      : std::signbit(*force.value) ? Part::slips_forwards
                                                                                   : Part::slips_backwards;
  }
  return out;
}

bool holds_more(const FrictionParts& here, const FrictionParts& there) {
  return here != there && std::ranges::equal(here, there, [](Part a, Part b) {
           return a == b || (a == Part::holds && b == Part::none);
         });
}

bool may_slip(const Mechanism& mechanism, CoordinateReference at) {
  const Joint& joint = joint_of(mechanism, at);
  const Coordinate& c = coordinate_of(mechanism, at);
  return !is_rotation_vector(joint.type, at.coordinate) && !c.spring && !c.stop;
}

std::vector<std::size_t> that_may_slip(const Mechanism& mechanism,
                                       const std::vector<CoordinateReference>& frictions) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < frictions.size(); ++i)
    if (may_slip(mechanism, frictions[i])) out.push_back(i);
  return out;
}

FrictionPart part_at_start(const Mechanism& mechanism, CoordinateReference friction) {
  for (const GearedCoordinate& geared : gear_train(mechanism, friction))
    if (const std::optional<Drive>& drive = coordinate_of(mechanism, geared.at).drive; drive && drive->torque)
      return drive->speed * geared.ratio > 0 ? Part::slips_forwards : Part::slips_backwards;
  return Part::none;
}

} // namespace flyball
