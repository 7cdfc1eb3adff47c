// Whether a damper acts, be it by a number or by a law.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

inline bool is_damped(const Coordinate& coordinate) {
  return coordinate.damping != 0 || coordinate.damping_force;
}

inline bool is_damped(const Force& spring) {
  return spring.damping != 0 || spring.damping_force;
}

// A spring between points that only damps.
inline bool is_damper_alone(const Force& spring) {
  return spring.stiffness == 0 && !spring.force && is_damped(spring);
}

} // namespace flyball
