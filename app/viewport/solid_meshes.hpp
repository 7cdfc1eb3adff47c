// The unit solids in OpenGL, and lists of their instances drawn with one call for each kind of solid.
#pragma once

#include "app/render/gl.hpp"
#include "app/viewport/scene_list.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flyball {

// World coordinates (m) less `origin`, divided by `length`: what reaches the shaders is of the order of one,
// however large or small the mechanism.
struct ViewUnits {
  Vec3 origin = Vec3::Zero();
  double length = 1;
};

class InstanceBatches {
 public:
  InstanceBatches();
  void set(std::span<const Instance> instances, const ViewUnits& units);
  int count() const { return count_; }

 private:
  friend class SolidMeshes;
  GlBuffer buffer_;
  std::array<int, primitive_count> counts_{};
  int count_ = 0;
};

class SolidMeshes {
 public:
  // With the program in use; returns the number of draw calls. Many instances are drawn with fewer triangles.
  int draw(const InstanceBatches& batches);

 private:
  struct Solid {
    GlVertexArray vertex_array;
    GlBuffer vertices, indices;
    GLsizei index_count = 0;
  };
  const Solid& solid(std::size_t primitive, int detail);
  std::array<std::array<Solid, primitive_count>, 3> solids_; // made when first drawn
};

} // namespace flyball
