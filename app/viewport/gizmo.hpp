// Handles to move and turn things by: where they are in the picture, which of them is under the cursor, and
// what dragging one means. They keep their size in the picture. No OpenGL, no ImGui.
#pragma once

#include "app/viewport/camera.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace flyball {

enum class Handle { none, x, y, z, yz, zx, xy, plane, ring_x, ring_y, ring_z };

std::string_view handle_name(Handle handle); // "x", "xy", "centre", "ring/z"
bool is_ring(Handle handle);
// The world axis (0 to 2) of an arrow or ring, the normal of a patch; -1 for the others.
int axis_of(Handle handle);
// Which of the three world coordinates dragging it may change; `normal` as in Gizmo.
std::array<bool, 3> free_coordinates(Handle handle, int normal);

enum class GizmoKind { arrows, rings };

struct Gizmo {
  GizmoKind kind = GizmoKind::arrows;
  Vec3 centre = Vec3::Zero(); // m, world
  int normal = 2;             // world axis across which the ball in the middle moves
  ViewCamera camera;
  ViewSize view;
  double point = 1; // pixels a point has
};

enum class HandleForm { arrow, patch, ball, ring };

// A handle as it is seen.
struct HandleShape {
  Handle handle = Handle::none;
  HandleForm form = HandleForm::arrow;
  std::vector<Vec2>
      line; // pixels; arrow: its two ends; patch: the corners; ball: the centre; ring: the near side
  std::vector<Vec2> far;    // ring: the side behind, from the end of `line` to its beginning
  Vec2 grip = Vec2::Zero(); // where one takes hold of it, clear of the others
};

// Those that can be used as the view stands, the farthest first. None where the centre is behind the eye.
std::vector<HandleShape> handle_shapes(const Gizmo& gizmo);
// Handle::none where the cursor is on none of them.
Handle handle_at(const std::vector<HandleShape>& shapes, Vec2 cursor, double point);
inline constexpr double ball_radius = 6.5; // points, of the ball in the middle

// How far the centre follows a cursor that went from one ray to another (m). Nothing where the view does not
// tell, as along an axis that points at the viewer.
std::optional<Vec3> dragged(const Gizmo& gizmo, Handle handle, const Ray& from, const Ray& to);
// How far a ring is turned (rad, right-handed, within half a turn).
std::optional<double> turned(const Gizmo& gizmo, Handle ring, const Ray& from, const Ray& to);

} // namespace flyball
