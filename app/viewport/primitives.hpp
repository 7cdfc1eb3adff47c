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

// `detail` from 0 to finest_detail, smooth from near; level_of_detail.hpp says which is drawn when. The three
// coarsest are for what is a few pixels large: they take as much of the picture as the solid does, rather
// than lie within it, and leave out holes and turns that nobody could see. Of them spheres are plane, to be
// turned with z to the eye, and capsules and coils, to be turned about z with y to the eye. A plane coil is a
// zigzag of wire; the coarsest is a strip, `round` half its width.
inline constexpr int detail_levels = 7, finest_detail = 6, last_flat_detail = 2;
PrimitiveMesh primitive_mesh(Primitive primitive, int detail);
constexpr bool is_flat(Primitive primitive, int detail) {
  return detail <= last_flat_detail && (primitive == Primitive::sphere || primitive == Primitive::capsule ||
                                        primitive == Primitive::coil || primitive == Primitive::open_coil);
}

// By detail: the sides of what is round.
inline constexpr std::array detail_sides{4, 6, 10, 16, 24, 40, 128};

// Of the tube, its hole's radius; of the coils, their turns.
inline constexpr double tube_hole = 0.62;
inline constexpr double coil_turns = 8;

} // namespace flyball
