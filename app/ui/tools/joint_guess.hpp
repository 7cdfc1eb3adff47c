// What a person most likely means by a joint at a point.
#pragma once

#include "app/document/part.hpp"
#include "app/viewport/scene_list.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flyball {

// Parent and child: the two selected bodies, else two that are at the point (within `reach`, m), else the
// ground and the nearest. What hangs on the ground already is the parent of what does not. Empty names
// without any body. Two that a joint joins already are offered last, and only where `again` says that this
// may be meant, as it is for a bearing. `instances` is the mechanism's scene in its drawn pose.
std::array<std::string, 2> guess_bodies(const Mechanism& mechanism, std::span<const Instance> instances,
                                        const Selection& selected, const Vec3& at, double reach, bool again);

// Whether one of the two is a disc that lies on the other, a rod, at the point, square across it: a flywheel
// on its shaft, which turns with it.
bool sits_on_shaft(const Mechanism& mechanism, const std::array<std::string, 2>& bodies, const Vec3& at);

// A direction that the two bodies have to offer beside the world's.
struct BodyAxis {
  std::string label; // "along rod1", "x of block1"
  Vec3 axis = Vec3::UnitZ();
};
std::vector<BodyAxis> body_axes(const Mechanism& mechanism, const std::array<std::string, 2>& bodies);

// Where the joint slides along a rod, or from the one body to the other, or, of a crank's block on the
// ground, from the crank's pivot to the block (along a world axis within 18 degrees), or upwards; otherwise
// across the picture. `normal` is the world axis (0 to 2) nearest to the line of sight.
Vec3 guess_axis(const Mechanism& mechanism, JointType type, const std::array<std::string, 2>& bodies,
                int normal);
// Of a bearing: that which one of the bodies turns about, the second rather; or along a rod, or across the
// picture.
Vec3 guess_shaft(const Mechanism& mechanism, const std::array<std::string, 2>& bodies, int normal);
// Along the rod on whose centre line a point is: what is put there as a disc sits on it. At a rod's end only
// where it turns about that line, as a shaft does; nothing where rods cross.
std::optional<Vec3> shaft_axis(const Mechanism& mechanism, const Vec3& at);
// A world axis at right angles to the axis, or its part that is.
Vec3 axis_across(const Vec3& axis);

} // namespace flyball
