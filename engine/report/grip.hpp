// A hand that takes hold of a point of a body in a steady state and pulls at it by a spring.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

struct Grip {
  // The body that the other end of the spring has to be fixed in, so that it turns with the drives as the
  // point does, and there is a steady state: the one that carries the nearest drive, or the ground. Empty:
  // the drives turn what nothing else turns with, the pulled body itself perhaps.
  std::string holder;
  // N/m: about that of the mechanism itself at this point, in the direction in which it gives way most, so
  // that it gives way by the greater part of what the hand moves. Where nothing gives way, what the body's
  // weight, the speeds and springs suggest.
  double stiffness = 0;
};

// In a steady state of the mechanism. Compiles, and factors the balance there. Throws SceneError for a body
// there is not.
Grip find_grip(const Mechanism& mechanism, const Solution& solution, const BodyPoint& point);

} // namespace flyball
