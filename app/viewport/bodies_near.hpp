// Which bodies are at a point: what a joint or spring put there is likely to hold.
#pragma once

#include "app/viewport/scene_list.hpp"

#include <span>
#include <vector>

namespace flyball {

struct NearBody {
  int body = -1;
  double distance =
      0; // m; zero or less where its form holds the point, zero where something is attached to it there
};

// Of the drawn pose, the nearest first; `instances` is the mechanism's scene in that pose.
std::vector<NearBody> bodies_near(const Mechanism& mechanism, std::span<const Instance> instances,
                                  const Vec3& point);

} // namespace flyball
