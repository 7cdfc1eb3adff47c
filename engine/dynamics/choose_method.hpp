// Which integrator suits a motion.
#pragma once

#include "engine/dynamics/equations.hpp"

namespace flyball {

struct MethodChoice {
  Integrator method = Integrator::runge_kutta;
  std::string reason;    // a sentence
  double rate_scale = 1; // 1/s, how fast the motion is as a rule
};

// From the linearised motion at an evaluated state: BDF where fast motions die out long before the end, for
// explicit steps stay as short as those ask for.
MethodChoice choose_method(Equations& equations, double duration, double tolerance, Integrator wanted);

} // namespace flyball
