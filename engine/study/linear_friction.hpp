// What dry friction makes of the mechanism that a linear model is of: what slips is driven by its limit, and
// what stands is rigid.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/study/linear_signals.hpp"

#include <string>
#include <vector>

namespace flyball {

// The signals' mechanism, driven from here on by the friction of what slips in the state, as by a constant
// number; the mechanism itself where nothing slips. Throws Refusal where that number is made of an input, or
// measures are of joints that are driven so.
Mechanism driven_by_slipping(const LinearSignals& signals, const StateOnFriction& state);

struct HeldCoordinate {
  std::string name; // as of coordinate_label()
  int v = 0;        // its entry of a step of q_R
};

// Those that dry friction holds in a steady state of the mechanism. Throws Refusal where it is at its limit.
std::vector<HeldCoordinate> held_by_friction(const Mechanism& mechanism, const MotionModel& model,
                                             const Solution& steady);

} // namespace flyball
