// Which part is under the cursor. No OpenGL.
#pragma once

#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"

#include <optional>
#include <span>

namespace flyball {

struct Hit {
  PartId part;
  double distance = 0;       // m along the ray
  Vec3 point = Vec3::Zero(); // m, world
};

// The nearest part the ray meets; where it meets none, the one it passes closest by within `slack` pixels.
std::optional<Hit> pick(std::span<const Instance> instances, const Ray& ray, double slack = 4);

} // namespace flyball
