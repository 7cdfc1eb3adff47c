// Round places: points of the mechanism that the cursor is near, the grid, round angles.
#pragma once

#include "app/document/snap_points.hpp"
#include "app/viewport/camera.hpp"

#include <array>
#include <span>

namespace flyball {

inline constexpr double snap_reach = 10; // points of the picture around a point that catches the cursor

// The point whose picture is nearest to the cursor, within `reach` pixels; of those that coincide in the
// picture the one nearest to the eye. A disc's face is meant only where the cursor is off what lies beside
// it. Null where there is none.
const SnapPoint* snap_point(std::span<const SnapPoint> points, const ViewCamera& camera, ViewSize view,
                            Vec2 cursor, double reach);

// The least of 1, 2 or 5 times a power of ten that is at least `size`; the nearest to it (by ratio).
double step_above(double size);
double nearest_step(double size);
// The multiple of the step nearest to the value: the double that "0.12" would be read as.
double round_to(double value, double step);
// The coordinates that are free rounded to the grid, the others as they are.
Vec3 on_grid(const Vec3& point, const std::array<bool, 3>& free, double step);
// To the nearest 15 degrees (rad).
double round_angle(double angle);

} // namespace flyball
