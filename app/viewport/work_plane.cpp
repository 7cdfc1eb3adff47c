#include "app/viewport/work_plane.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

int axis_in_view(const ViewCamera& camera) {
  Vec3 along = camera.backward().cwiseAbs();
  // A tie goes to z, then y: drawings are made in the plane of x and y.
  constexpr double tie = 1e-9;
  if (along.z() >= along.maxCoeff() - tie) return 2;
  return along.y() >= along.x() - tie ? 1 : 0;
}

WorkPlane work_plane(const ViewCamera& camera, const Vec3& through) {
  return {through, axis_in_view(camera)};
}

std::optional<Vec3> meet(const WorkPlane& plane, const Ray& ray) {
  const double slope = ray.direction[plane.normal];
  if (std::abs(slope) < 1e-3) return std::nullopt;
  const double along = (plane.through[plane.normal] - ray.origin[plane.normal]) / slope;
  if (!(along > 0)) return std::nullopt;
  Vec3 point = ray.origin + along * ray.direction;
  point[plane.normal] = plane.through[plane.normal];
  return point;
}

double metres_per_pixel(const ViewCamera& camera, const Vec3& at, ViewSize view) {
  const double size = camera.pixel_size(view);
  if (camera.orthographic) return size;
  const double ahead = (camera.eye() - at).dot(camera.backward());
  return size * std::max(ahead, 1e-3 * camera.distance) / camera.distance;
}

} // namespace flyball
