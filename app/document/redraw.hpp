// The same mechanism drawn in another of its configurations.
//
// Every body is where the configuration has it, with its shapes; joints, ends of springs and points of forces
// are carried along by their bodies, coordinates are labelled with what they have come to. So nothing of the
// mechanism has changed: lengths, masses, where springs are slack and stops act, what settles where; but for
// what Redrawn tells.
//
// The axes of spherical and free joints are the world's. Where their parent has turned, springs, stops and
// drives along single ones of them are carried along as far as coordinate_image.hpp says.
#pragma once

#include "engine/mechanism/mechanism_pose.hpp"

#include <string>
#include <vector>

namespace flyball {

struct Redrawn {
  Mechanism mechanism;
  // Spherical and free joints with springs, stops or drives along axes that have turned with the parent and
  // are none of the world's any more: those act along the world's axes now.
  std::vector<std::string> along_other_axes;
  // Bearings whose second body has moved in the first: a bearing is slack as it is drawn, and so they are
  // slack there now.
  std::vector<std::string> slack_elsewhere;
};

// `pose`: bodies and joints as in `mechanism`, loops closed.
Redrawn redrawn(const Mechanism& mechanism, const MechanismPose& pose);

// Whether that would move anything.
bool is_drawn_in(const Mechanism& mechanism, const MechanismPose& pose);

} // namespace flyball
