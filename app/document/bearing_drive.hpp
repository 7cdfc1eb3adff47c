// A drive for a body in elastic bearings, which leave it six coordinates, none of them a turn that could be
// driven.
//
// The bearings then hold a sleeve without mass, which slides across their axis both ways, along it too where
// they act there, and tilts as a universal joint does; in it the body turns about the axis. So it shifts and
// tilts as it did, and stays as drawn along the axis if nothing has held it there. A hinge about the axis
// between the two that the bearings are between, which takes all load from them, is from then on the one in
// the sleeve.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <vector>

namespace flyball {

// The body that a bearing holds: its second, or the first where that is the ground.
const std::string& held_by(const Force& bearing);

// Why a body cannot be given one, a sentence; empty where it can.
std::string bearing_drive_refused(const Mechanism& mechanism, const std::string& body);

// A body that can be given one.
struct BodyInBearings {
  std::string body;
  std::string hinge; // that takes all load from them; empty: none
};
std::vector<BodyInBearings> bodies_in_bearings(const Mechanism& mechanism);

// Gives it one, of that speed (rad/s), unless its hinge has one already; the name of the joint that is
// driven. Throws SceneError where it cannot be done.
std::string give_bearing_drive(Mechanism& mechanism, const std::string& body, double speed);

} // namespace flyball
