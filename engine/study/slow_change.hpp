// Several joints with dry friction while a number of their mechanism goes slowly from end to end and back.
// Each stands while less than its limit holds it, and slips against its limit as far as that drives it: the
// quasi- static motion, whose rates solve a linear complementarity problem (Moreau; Krejci, Hysteresis,
// Convexity and Dissipation, 1996). The state is that of the shares that each joint gives of its limit, so it
// is followed along the steady states from one change between standing and slipping to the next.
#pragma once

#include "engine/study/friction_ribbon.hpp"

namespace flyball {

struct SlowChange {
  std::vector<std::vector<HysteresisPoint>> way; // by name, then by place; in rad, m or the measure's unit
  std::string message;                           // why there is none
};

// The way of what is asked for (found numbers and measures) over the places, in whose order the number goes
// forth, and back; once it goes round the same way again and again. Refused where the number turns back among
// the places, where loops tie the joints to each other, where two of them could begin to slip in more than
// one way, and where the state jumps.
SlowChange find_slow_change(const Mechanism& mechanism, const std::string& address,
                            std::span<const RibbonPlace> places, const std::vector<std::string>& names,
                            const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
