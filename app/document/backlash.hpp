// Play between the teeth of a gear, of parts that there are.
//
// The wheel is hung in a rim without mass, by a joint whose stops are half the play away and as stiff as the
// teeth. The rim turns by the gear as the wheel did before, without play; the wheel is where the rim is, and
// as far from there as the play and its load leave it. What is geared to the wheel beyond follows by the same
// gears once more: a rim turns as the rim does, and in it a wheel as the wheel in its rim.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball {

// What it begins with, to be changed at once.
struct UsualMesh {
  double play;      // rad or m
  double stiffness; // N m/rad or N/m
  double damping;   // N m s/rad or N s/m, in the play too; it changes no steady state
};
inline constexpr UsualMesh usual_mesh_of_angles{0.01, 1e5, 10}, usual_mesh_of_slides{1e-4, 1e7, 500};

// Why a gear, belt, rack or screw cannot have any, a sentence; empty where it can.
std::string backlash_refused(const Mechanism& mechanism, const std::string& gear);

// Gives it some, by a named parameter, on the side that its drive does not turn; the name of the joint with
// the play. Throws SceneError where it cannot be done.
std::string give_backlash(Mechanism& mechanism, const std::string& gear);

} // namespace flyball
