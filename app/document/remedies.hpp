// What gives a mechanism without a steady state one: holding what runs away, and gravity where it does not
// turn with the drives.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>

namespace flyball {

// A free coordinate along which `force` (N or N m, positive along it) pushes on without end.
struct RunawayCoordinate {
  std::string joint;
  int index = 0;
  double force = 0;
};

// Whether a spring or stop can be put on it: the joint is the mechanism's own and has none there yet.
bool can_hold(const Mechanism& mechanism, const RunawayCoordinate& coordinate);
// A spring that is slack as drawn and gives way by about a fifth of the mechanism's size, or 0.3 rad; nothing
// where can_hold() is false.
void add_holding_spring(Mechanism& mechanism, const RunawayCoordinate& coordinate);
// A stop as far away, on the side that it is pushed to, that gives way a hundred times less.
void add_holding_stop(Mechanism& mechanism, const RunawayCoordinate& coordinate);

// Gravity of the present size along the axis of all drives that turn, to the side that it points to now, else
// downwards. Nothing where there is no gravity, it is along the axis already, or drives turn about several.
std::optional<Vec3> gravity_along_drives(const Mechanism& mechanism);

} // namespace flyball
