// What goes into a linear model and what comes out of it, by the names a person gives.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

// As a person wrote it, in an SI unit, with its value in the steady state.
struct LinearSignal {
  std::string name, unit;
  double value = 0;
};

struct LinearInput : LinearSignal {
  std::string address; // of the number that it adds to, in LinearSignals::mechanism; or
  int joint = -1;      // it is a torque or force along
  int coordinate = 0;  // this coordinate of this joint
  bool force = false;  // the number is a component of a force on a body
};

struct LinearSignals {
  // The mechanism with what is asked for as parts of it: forces of size zero, and measures after its own.
  Mechanism mechanism;
  std::vector<LinearInput> inputs;
  std::vector<LinearSignal> outputs; // the last of the measures; no values yet
  // By output: the name of the state (LinearModel::states) that it is by itself where that is one, as
  // "slide.rate" of "rate(slide)"; else empty.
  std::vector<std::string> as_states;
};

// Inputs: the address of a number; `torque(JOINT)`, a torque or force added along a coordinate, positive
// along it; `force_x(POINT)`, `force_y`, `force_z`: a force on a body at a point, "ball" or "ball@A", along
// an axis of the world. Outputs: a measure's name, a coordinate's, or what a measure may ask for,
// "rate(slide)". Throws SceneError that names the text.
LinearSignals read_signals(const Mechanism& mechanism, std::span<const std::string> inputs,
                           std::span<const std::string> outputs);

} // namespace flyball
