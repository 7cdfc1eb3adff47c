// A slider-crank drawn in the plane across z: rod1 is the crank, about z through the origin, rod2 goes from
// it to block1, where the pin is.
#pragma once

#include "app/document/create.hpp"
#include "app/document/formula_edits.hpp"

namespace flyball::test {

inline const Vec3 slider_crank_pin{0.3, 0, 0}; // m

// Hinged, the block not yet held.
inline void add_slider_crank(Mechanism& mechanism) {
  const Vec3 elbow(0.1, 0.1, 0);
  const auto rod = [&](const Vec3& from, const Vec3& to) {
    add_body(mechanism, {.form = BodyForm::rod, .radius = 0.01, .from = from, .to = to});
  };
  rod(Vec3::Zero(), elbow);
  rod(elbow, slider_crank_pin);
  add_body(mechanism, {.form = BodyForm::block, .at = slider_crank_pin, .size = {0.06, 0.06, 0.06}});
  const auto hinge = [&](const char* parent, const char* child, const Vec3& at) {
    add_joint(mechanism, JointType::revolute, {parent, child}, at, Vec3::UnitZ());
  };
  hinge("ground", "rod1", Vec3::Zero());
  hinge("rod1", "rod2", elbow);
  hinge("rod2", "block1", slider_crank_pin);
}

// Driven, with its slide: it moves periodically, as nothing of it can stand still.
inline void add_driven_slider_crank(Mechanism& mechanism, double speed) {
  add_slider_crank(mechanism);
  mechanism.joints.front().coordinates.front().drive.emplace().speed = speed;
  add_joint(mechanism, JointType::prismatic, {"ground", "block1"}, slider_crank_pin, Vec3::UnitX());
}

// The same by a torque that falls as it turns faster.
inline void add_slider_crank_by_torque(Mechanism& mechanism) {
  add_driven_slider_crank(mechanism, 20);
  const Joint& crank = mechanism.joints.front();
  mechanism.joints.front().coordinates.front().drive->torque = 0;
  set_expression(mechanism, "joints." + crank.name + ".drive.torque",
                 "60 N m - 3 N m s*rate(" + crank.name + ")");
}

} // namespace flyball::test
