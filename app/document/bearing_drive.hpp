// A drive for a body that elastic bearings hold: these leave it six coordinates, of which none is a turn that
// could be driven. The bearings then hold a sleeve without mass, which slides across their axis, and along it
// where they are stiff there, and tilts; in it the body turns about the axis.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball {

// Why a body cannot be given one, a sentence; empty where it can.
std::string bearing_drive_refused(const Mechanism& mechanism, const std::string& body);

// Gives it one, of that speed (rad/s); the name of the joint that is driven. Throws SceneError where it
// cannot be done.
std::string give_bearing_drive(Mechanism& mechanism, const std::string& body, double speed);

} // namespace flyball
