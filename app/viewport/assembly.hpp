// A mechanism made ready for drawing: names resolved, every body's points of attachment, the glyphs' size.
#pragma once

#include "app/viewport/scene_list.hpp"
#include "app/viewport/toothed_wheels.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flyball {

// Where something holds a body (m, drawn pose).
struct Attachment {
  Vec3 at = Vec3::Zero();
  int joint = -1; // in the mechanism's list; -1 for the end of a spring
  int end = 0;    // 0: the body is the joint's first, 1: its second
};

// A body that turns about an axis of ground through its mass centre and all its points (or only the former,
// where its shapes are given): drawn as a shaft.
struct Shaft {
  Vec3 origin = Vec3::Zero();     // m, drawn pose
  Vec3 direction = Vec3::UnitY(); // unit length, from the end held by ground
  double from = 0, to = 0;        // m, its ends along `direction`
  double base = 0;                // m, radius of the given shape that stands on ground; 0 without
  double base_height = 0;         // m
  int joint = -1;                 // that it turns in
};

struct Assembly {
  const Mechanism& mechanism;
  std::span<const Pose> poses;
  std::vector<std::array<int, 2>> joint_bodies;     // -1: ground
  std::vector<std::array<int, 2>> force_bodies;     // spring, bearing: both; others: the body, then -1
  std::vector<std::vector<Attachment>> attachments; // by body
  SceneScale scale;
  std::vector<double> crank_travel;         // m, by joint: how far cranks may push a slide to either side
  std::vector<std::optional<Shaft>> shafts; // by body: as what it is drawn, if it is one
  std::vector<std::array<ToothedWheel, 2>> wheels; // by joint
  std::vector<double>
      balls; // m, by body: radius of the ball drawn about its mass centre, 0 for none; empty until then
  double middle_mass = 0;                  // kg, the median of the bodies that have mass
  std::array<double, 6> largest_vectors{}; // N or N m, by type of force

  Assembly(const Mechanism& built, std::span<const Pose> in_poses);

  Vec3 point(int body, const Vec3& drawn) const { return carried_point(mechanism, poses, body, drawn); }
  Vec3 vector(int body, const Vec3& drawn) const { return carried_vector(mechanism, poses, body, drawn); }
  const Joint& joint(int index) const { return mechanism.joints[static_cast<std::size_t>(index)]; }
};

// Box around a body's shapes (m, drawn pose): near enough for glyphs where they are turned.
Bounds shape_bounds(const Body& body);

// Whether a ball of this radius at a point (m, world) is all inside that of a body, as in a net of thousands
// of them.
bool within_ball(const Assembly& assembly, int body, const Vec3& at, double radius);

// One coordinate of a joint: along or about what, as drawn and fixed in the joint's parent (or child, for
// the second axis of a universal joint).
struct CoordinateAxis {
  Vec3 axis = Vec3::UnitZ(); // unit length, drawn pose
  int end = 0;               // 0: fixed in the parent, 1: in the child
  bool angle = false;
};
CoordinateAxis coordinate_axis(const Joint& joint, std::size_t coordinate);

// The coordinate's value in the poses, for springs' colours: the drawn value plus how far the child has moved
// along or turned about the axis (within half a turn).
double coordinate_value(const Assembly& assembly, std::size_t joint, std::size_t coordinate);

// Values a slide is likely to take (m, its coordinate): drawn, slack, its stops, as far as a crank pushes it,
// and where it stands in the poses.
struct SlideRange {
  double from = 0, to = 0;
  // Where the other end of its spring and damper sits: outside what the coordinate takes but for stops, so
  // that it always lies on the same side, and on the shapes of what it slides on where the slide leads to
  // them. It gives way only to poses beyond all that.
  double anchor = 0;
  double below = 0, above = 0; // m, how far the shapes of what slides extend from its point either way
};
SlideRange slide_range(const Assembly& assembly, std::size_t joint, std::size_t coordinate);
// Whether a spring or damper acts along the slide, and so has its anchor there.
bool has_anchor(const Coordinate& coordinate);

// As what a body is drawn, if it is one; ground (-1) is none.
std::optional<Shaft> shaft_of(const Assembly& assembly, int body);
// Whether it has the base of a wheel or turntable, by the size of glyphs.
bool is_broad(const Shaft& shaft, double unit);
// Whether a gear, belt, rack or screw ties the joint to another.
bool is_geared(const Mechanism& mechanism, const std::string& joint);
// Whether a point of the drawn pose lies on its axis, by the size of glyphs.
bool on_axis(const Shaft& shaft, const Vec3& drawn, double unit);

// Which end of a prismatic or cylindrical joint is drawn as the slider (0 or 1); the other is its rail.
int slider_end(const Assembly& assembly, std::size_t joint);
// Whether the slider is drawn as a collar round a shaft rather than as a block.
bool slides_on_shaft(const Assembly& assembly, std::size_t joint);

} // namespace flyball
