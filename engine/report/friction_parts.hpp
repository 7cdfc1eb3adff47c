// Which part dry friction plays in each coordinate of a steady state that rests on it.
#pragma once

#include "engine/report/analysis.hpp"

#include <vector>

namespace flyball {

// What dry friction does in a coordinate that has some.
enum class FrictionPart {
  none,  // nothing, or what its share of the limit says: it rests in balance
  holds, // the coordinate as it is drawn
  slips_forwards,
  slips_backwards,
};
using FrictionParts = std::vector<FrictionPart>; // by find_frictions()

struct StateOnFriction {
  Analysis analysis; // of the mechanism with such joints driven so, at the state
  Solution solution; // in the mechanism's own words, with Solution::frictions
  FrictionParts parts;
  std::vector<bool> implied; // of what slips: the drives give its rate, by coordinate with friction
  // By coordinate with friction, above zero where its part is as it is taken to be: of what slips the rate
  // the way it slips (rad/s or m/s), of what is held the part of the limit that is left. Where loops leave it
  // open how joints share, that of all; infinite of those without a part.
  std::vector<double> margins;
  bool goes = false; // all parts are as they are taken to be, beyond the errors of rates
};

inline bool is_slipping(FrictionPart part) {
  return part == FrictionPart::slips_forwards || part == FrictionPart::slips_backwards;
}

// The parts that friction has in a state that rests on it.
FrictionParts parts_of(const Mechanism& mechanism, std::span<const FrictionForce> frictions);

// Whether a state with the first parts is one with the others, too: all that has a part there has the same
// one here, and the rest, which there rests in balance, is held here.
bool holds_more(const FrictionParts& here, const FrictionParts& there);

// Whether a coordinate may slip at a constant rate without end: along one axis, without spring or stop.
bool may_slip(const Mechanism& mechanism, CoordinateReference at);
// Those that may, by coordinate with friction.
std::vector<std::size_t> that_may_slip(const Mechanism& mechanism,
                                       const std::vector<CoordinateReference>& frictions);

// Of what a torque turns, itself or through gears, the way of the speed with which its search begins.
FrictionPart part_at_start(const Mechanism& mechanism, CoordinateReference friction);

} // namespace flyball
