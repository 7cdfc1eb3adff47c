// The unit solids as triangles. No OpenGL.
#pragma once

#include "app/viewport/scene_list.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace flyball {

// See Primitive: the surface point is  core * extent + normal * round.
struct PrimitiveVertex {
  std::array<float, 3> core, normal;
};

struct PrimitiveMesh {
  std::vector<PrimitiveVertex> vertices;
  std::vector<std::uint32_t> indices; // three a triangle, counter-clockwise seen from outside
};

// `detail` 2 is smooth from near; 1 and 0 have about a fifth and a twentieth of the triangles, for thousands
// of bodies.
PrimitiveMesh primitive_mesh(Primitive primitive, int detail);

// Of the tube, its hole's radius; of the coils, their turns.
inline constexpr double tube_hole = 0.62;
inline constexpr double coil_turns = 8;

} // namespace flyball
