// Which parts a frame drawn over the picture holds.
#pragma once

#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"

#include <array>
#include <span>
#include <vector>

namespace flyball {

// Where a part stands in the poses: a body's mass centre, a joint's or force's point, the middle of a spring
// or link.
struct PartAnchor {
  PartId part;
  Vec3 at = Vec3::Zero(); // m, world
};
std::vector<PartAnchor> part_anchors(const Mechanism& mechanism, std::span<const Pose> poses);

// Those whose anchor is seen within the frame between two corners (pixels, any two that face each other).
std::vector<PartId> parts_in_frame(std::span<const PartAnchor> anchors, const ViewCamera& camera,
                                   ViewSize view, const std::array<Vec2, 2>& corners);

} // namespace flyball
