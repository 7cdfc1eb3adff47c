// The ratio of a gear of any kind: q_b = ratio q_a + offset.
//
//   gear   as given; below zero where outer teeth mesh
//   belt   r_a / r_b, since the rim of both runs at the belt's speed; below zero where it is crossed, if both
//          coordinates grow as their wheels turn the same way in space, see wheels_turn_alike()
//   rack   r (m/rad), since the rack runs at the speed of the pinion's pitch circle
//   screw  lead / 2 pi (m/rad)
#pragma once

#include "engine/mechanism/number_rates.hpp"

#include <numbers>

namespace flyball {

// In N, as `read` reads the mechanism's numbers.
template <class N>
N gear_ratio(const Joint& gear, const NumberReader<N>& read) {
  switch (gear.kind) {
  case GearKind::gear: break;
  case GearKind::belt: return read(gear.radii[0]) / read(gear.radii[1]) * N(gear.crossed ? -1. : 1.);
  case GearKind::rack: return read(gear.radii[0]);
  case GearKind::screw: return read(gear.lead) / N(2 * std::numbers::pi);
  }
  return read(gear.ratio);
}

inline double gear_ratio(const Joint& gear) {
  return gear_ratio(gear, NumberReader<double>());
}

// Whether the wheels of a belt turn the same way in space as both coordinates grow: by the axes as drawn, and
// by which of their bodies the joints have in common, which carries both wheels (if none, the first ones do).
// True where the axes are not parallel.
bool wheels_turn_alike(const Mechanism& mechanism, const Joint& belt);

} // namespace flyball
