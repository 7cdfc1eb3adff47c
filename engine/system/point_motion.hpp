// How points of bodies move.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/system/kinematics.hpp"

namespace flyball {

// A point of a body as the passes see it.
struct TrackedPoint {
  int link = -1;
  Offset at = Offset::Zero();
};

// Throws SceneError where there is no such body; "ground" is none.
TrackedPoint find_point(const System& system, const Mechanism& mechanism, const Parameters& parameters,
                        const BodyPoint& point);

// At evaluated kinematics: with only the drives turning as forward() leaves them, or of any motion as move()
// does.
PointMotion point_motion(const Parameters& parameters, const Kinematics<double>& kinematics,
                         const TrackedPoint& point);

} // namespace flyball
