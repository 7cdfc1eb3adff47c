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
  std::size_t instance = 0;  // that was met, in the list
};

// The nearest part the ray meets; where it meets none, the one it passes closest by within `slack` pixels.
std::optional<Hit> pick(std::span<const Instance> instances, const Ray& ray, double slack = 4);

// Signed distance (m) of a point from the instance's surface, negative within; coils, spirals and gears count
// as the solid they sweep.
double surface_distance(const Instance& instance, const Vec3& point);

} // namespace flyball
