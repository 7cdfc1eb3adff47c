// A governor for the tests of the viewport, without shapes.
#pragma once

#include "tests/support/parts.hpp"

namespace flyball::test {

inline Mechanism governor() {
  Mechanism m;
  m.name = "Governor";
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("spindle", 200, {0, 0.2, 0}), body("ball1", 1, {-0.16, 0.2, 0}),
              body("ball2", 1, {0.16, 0.2, 0}), body("collar", 1, {0, 0.1256, 0})};
  Joint spin = revolute("spin", "ground", "spindle", {0, 0.2, 0}, {0, 1, 0});
  spin.coordinates[0].drive = Drive{11.0174};
  Joint slide = prismatic("slide", "spindle", "collar", {0, 0.1256, 0}, {0, -1, 0});
  slide.coordinates[0].drawn = 0.0744;
  slide.coordinates[0].spring = CoordinateSpring{1000, 0.15};
  slide.coordinates[0].damping = 30;
  m.joints = {spin,
              revolute("arm1", "spindle", "ball1", {0, 0.2, 0}, {0, 0, 1}),
              revolute("arm2", "spindle", "ball2", {0, 0.2, 0}, {0, 0, 1}),
              slide,
              distance("link1", "ball1", "collar", {-0.08, 0.2, 0}, {0, 0.1256, 0}),
              distance("link2", "ball2", "collar", {0.08, 0.2, 0}, {0, 0.1256, 0})};
  return m;
}

} // namespace flyball::test
