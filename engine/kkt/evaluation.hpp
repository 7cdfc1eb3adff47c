// The balance evaluated at a state.
#pragma once

#include "engine/system/residual.hpp"

namespace flyball {

struct Evaluation {
  Kinematics<double> kinematics;
  Residual<double> residual; // f and phi of eq. 23
  Magnitudes magnitudes;     // sizes of the terms, by which rounding is judged
};

} // namespace flyball
