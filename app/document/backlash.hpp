// Play between the teeth of a gear, of parts that there are.
//
// The wheel is hung in a rim without mass, by a joint whose stops are half the play away and as stiff as the
// teeth, and a damper, so that it does not rattle for ever. The rim turns by the gear as the wheel did
// before, without play; the wheel is where the rim is, and as far from there as the play and its load leave
// it. What is geared to the wheel beyond follows by the same gears once more: a rim turns as the rim does,
// and in it a wheel as the wheel in its rim.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball {

inline constexpr double usual_play_angle = 0.01, usual_play_length = 1e-4;    // rad, m
inline constexpr double usual_mesh_torsion = 1e5, usual_mesh_stiffness = 1e7; // N m/rad, N/m
inline constexpr double usual_mesh_damping = 1, usual_slide_damping = 100;    // N m s/rad, N s/m

// Why a gear, belt, rack or screw cannot have any, a sentence; empty where it can.
std::string backlash_refused(const Mechanism& mechanism, const std::string& gear);

// Gives it some, by a named parameter, on the side that its drive does not turn; the name of the joint with
// the play. Throws SceneError where it cannot be done.
std::string give_backlash(Mechanism& mechanism, const std::string& gear);

} // namespace flyball
