// The unit solids in OpenGL, and lists of their instances drawn with one call for each kind and fineness of
// solid.
#pragma once

#include "app/render/gl.hpp"
#include "app/viewport/level_of_detail.hpp"
#include "app/viewport/primitives.hpp"
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
  // Takes over what is to be seen of the instances. `thinned` as in see().
  void set(std::span<const Instance> instances, const ViewUnits& units, const Sight& sight,
           bool thinned = true);
  int count() const { return count_; } // of those to be seen

 private:
  friend class SolidMeshes;
  struct GpuInstance {
    float position_round[4], rotation[4], extent_surface[4], tint[4];
  };
  static std::size_t kind_of(Primitive primitive, int detail) {
    return static_cast<std::size_t>((finest_detail - detail) * primitive_count + static_cast<int>(primitive));
  }
  static Primitive primitive_of(std::size_t kind) { return static_cast<Primitive>(kind % primitive_count); }
  static int detail_of(std::size_t kind) { return finest_detail - static_cast<int>(kind / primitive_count); }
  static GpuInstance gpu_instance(const Instance& instance, const SeenSolid& seen, const ViewUnits& units);
  static bool drawable(const GpuInstance& instance);

  static constexpr std::size_t kinds = static_cast<std::size_t>(primitive_count) * detail_levels;
  GlBuffer buffer_;
  std::size_t room_ = 0; // bytes of the buffer
  // By solid and detail, the finest first, as they hide what is small; they keep their memory.
  std::array<std::vector<GpuInstance>, kinds> kept_;
  int count_ = 0;
};

class SolidMeshes {
 public:
  // Those of a range of details, with the program in use; returns the number of draw calls.
  int draw(const InstanceBatches& batches, int from = 0, int to = finest_detail);

 private:
  struct Solid {
    GlVertexArray vertex_array;
    GlBuffer vertices, indices;
    GLsizei index_count = 0;
  };
  const Solid& solid(std::size_t kind);
  std::array<Solid, InstanceBatches::kinds> solids_; // made when first drawn
};

} // namespace flyball
