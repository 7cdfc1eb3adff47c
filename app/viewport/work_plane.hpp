// Where a flat cursor is in space: on a plane across a world axis.
#pragma once

#include "app/viewport/camera.hpp"

namespace flyball {

struct WorkPlane {
  Vec3 through = Vec3::Zero(); // m
  int normal = 2;              // the world axis (0 to 2) at right angles to it
};

// The world axis (0 to 2) nearest to the direction one looks in.
int axis_in_view(const ViewCamera& camera);
// The plane through the point that one sees best.
WorkPlane work_plane(const ViewCamera& camera, const Vec3& through);
// Where the ray meets the plane (m), its coordinate across the plane exact; nothing where it does so behind
// the eye, or hardly at all.
std::optional<Vec3> meet(const WorkPlane& plane, const Ray& ray);
// Metres across one pixel at a point.
double metres_per_pixel(const ViewCamera& camera, const Vec3& at, ViewSize view);

} // namespace flyball
