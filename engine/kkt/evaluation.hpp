// What the balance comes to at a state.
#pragma once

#include "engine/system/residual.hpp"

namespace flyball {

struct Evaluation {
  Kinematics<double> kinematics;
  Residual<double> residual; // f and phi of eq. 23
  Magnitudes magnitudes;     // what rounding is told by
};

} // namespace flyball
