// Moving and turning parts in the drawn pose.
//
// A body takes along what is its own: mass centre, axes, shapes, the ends of springs and distance joints on
// it, the points of forces on it, and joints of which every body moves (the ground never does); with
// OuterJoints::follow also joints and bearings to what stays, the ground included: their point and axis go
// with the body, and are another place of what stays. A joint or bearing selected by itself moves its point
// and axis; another force or a distance joint selected by itself moves all its points. A rotation also turns
// axes and inertia's frame (the body's `rotation`). A force's vector in body axes goes with the body; in
// world axes it turns only where the force is selected. Coordinates of spherical and free joints have the
// world's axes: they trade places as these do, gears and sliders following (see coordinate_image.hpp).
// Nothing moves twice, and nothing by numbers that are not finite.
#pragma once

#include "app/document/part.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Joints between a body that moves and one that stays.
enum class OuterJoints { stay, follow };

void move_parts(Mechanism& mechanism, const Selection& selection, const Vec3& by, // m
                OuterJoints joints = OuterJoints::stay);
void rotate_parts(Mechanism& mechanism, const Selection& selection, const Vec3& centre, // m, world
                  const Quat& rotation, OuterJoints joints = OuterJoints::stay);
// Their names, in the mechanism's order: not those selected, which move by themselves, and neither gears nor
// distance joints, of which each end goes with its body.
std::vector<std::string> outer_joints(const Mechanism& mechanism, const Selection& selection);

// A point that a person can take hold of: a joint's or force's `at` (end 0), an end of a spring or distance
// joint (0 or 1), a body's mass centre (0).
struct PointId {
  Part part;
  int end = 0;
  bool operator==(const PointId&) const = default;
};
// Nothing where the part has no such point.
std::optional<Vec3> point_position(const Mechanism& mechanism, const PointId& point);
// The address of its three numbers, "joints.arm.at"; of a body the one that all of it follows,
// "bodies.ball.position"; empty where its shapes have places of their own.
std::string point_address(const Mechanism& mechanism, const PointId& point);
// Moves this point alone (for a body: the whole body). A spring's free length and a distance joint's length
// that are given stay as they are.
void set_point(Mechanism& mechanism, const PointId& point, const Vec3& position,
               OuterJoints joints = OuterJoints::stay);

// Mean of the selected parts' points: where a gizmo stands. Nothing for a selection without points.
std::optional<Vec3> centre_of(const Mechanism& mechanism, const Selection& selection);

} // namespace flyball
