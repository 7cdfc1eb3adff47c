#include "app/viewport/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double nearest_plane = 1e-12, farthest_plane = 1e15; // m
constexpr double steepest = std::numbers::pi / 2;

// Horizontal axes of a view from azimuth 0: to the right and towards the viewer.
struct Horizon {
  Vec3 right, front;
};

Horizon horizon(const Vec3& up) {
  const Vec3 seed =
      std::abs(up.x()) < 0.9 ? Vec3(Vec3::UnitX()) : Vec3(-std::copysign(1.0, up.x()) * Vec3::UnitY());
  const Vec3 right = (seed - up * up.dot(seed)).normalized();
  return {right, right.cross(up)};
}

double half_height(const ViewCamera& camera) {
  return std::tan(0.5 * camera.field_of_view);
}

} // namespace

Vec3 up_axis(const Mechanism& mechanism) {
  const double g = mechanism.gravity.stableNorm();
  return g > 0 && std::isfinite(g) ? Vec3(-mechanism.gravity / g) : Vec3(Vec3::UnitY());
}

Vec3 ViewCamera::right() const {
  const Horizon h = horizon(up);
  return std::cos(azimuth) * h.right - std::sin(azimuth) * h.front;
}

Vec3 ViewCamera::backward() const {
  const Horizon h = horizon(up);
  return std::cos(elevation) * (std::sin(azimuth) * h.right + std::cos(azimuth) * h.front) +
         std::sin(elevation) * up;
}

Vec3 ViewCamera::screen_up() const {
  return backward().cross(right());
}

Vec3 ViewCamera::eye() const {
  return target + distance * backward();
}

void ViewCamera::orbit(double dx, double dy, ViewSize view) {
  const double turn = std::numbers::pi / std::max(view.height, 1.0);
  azimuth = std::remainder(azimuth - turn * dx, 2 * std::numbers::pi);
  elevation = std::clamp(elevation + turn * dy, -steepest, steepest);
}

void ViewCamera::pan(double dx, double dy, ViewSize view) {
  target += pixel_size(view) * (dy * screen_up() - dx * right());
}

void ViewCamera::zoom(double factor, Vec2 cursor, ViewSize view) {
  const double next = std::clamp(distance / factor, nearest_plane, farthest_plane);
  const double x = cursor.x() - 0.5 * view.width, y = 0.5 * view.height - cursor.y();
  target += (1 - next / distance) * pixel_size(view) * (x * right() + y * screen_up());
  distance = next;
}

void ViewCamera::fit(const Bounds& bounds, ViewSize view, double margin) {
  const double tan_y = half_height(*this), tan_x = tan_y * view.width / std::max(view.height, 1.0);
  const double radius = bounds.empty ? 0 : bounds.radius();
  target = bounds.empty ? Vec3(Vec3::Zero()) : bounds.center();
  if (!(radius > 0)) {
    distance = margin / std::min(tan_x, tan_y);
    return;
  }
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) {
      const bool high = (i >> k) & 1;
      corners[i][k] = (high ? bounds.upper : bounds.lower)[k];
    }
  const Vec3 x = right(), y = screen_up(), z = backward();
  // Perspective shows near corners larger, so the middle of the picture is found in a few steps.
  for (int step = 0; step < 4; ++step) {
    double far_enough = 0;
    for (const Vec3& corner : corners) {
      const Vec3 d = corner - target;
      const double ahead = orthographic ? 0 : d.dot(z);
      // What is long towards the eye, as a shaft seen from its end, is at most so many times as large there
      // as at the target.
      constexpr double largest = 2;
      far_enough =
          std::max({far_enough, largest / (largest - 1) * ahead, ahead + margin * std::abs(d.dot(x)) / tan_x,
                    ahead + margin * std::abs(d.dot(y)) / tan_y});
    }
    distance = std::clamp(std::max(far_enough, 1e-3 * radius), nearest_plane, farthest_plane);
    if (orthographic) return;
    Vec2 low(1e300, 1e300), high(-1e300, -1e300);
    for (const Vec3& corner : corners) {
      const Vec3 d = corner - target;
      const Vec2 place = Vec2(d.dot(x), d.dot(y)) / std::max(distance - d.dot(z), 1e-3 * distance);
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    const Vec2 middle = 0.5 * distance * (low + high);
    target += middle.x() * x + middle.y() * y;
  }
}

Mat4 ViewCamera::view_matrix() const {
  Mat4 m = Mat4::Identity();
  m.block<1, 3>(0, 0) = right().transpose();
  m.block<1, 3>(1, 0) = screen_up().transpose();
  m.block<1, 3>(2, 0) = backward().transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye();
  return m;
}

Mat4 ViewCamera::projection_matrix(ViewSize view, const Vec3& around, double reach) const {
  const double along = (eye() - around).dot(backward());
  const double aspect = view.width / std::max(view.height, 1.0);
  Mat4 m = Mat4::Zero();
  if (orthographic) {
    const double near = along - reach, far = along + std::max(reach, 1e-6 * distance);
    const double h = distance * half_height(*this);
    m(0, 0) = 1 / (h * aspect);
    m(1, 1) = 1 / h;
    m(2, 2) = -2 / (far - near);
    m(2, 3) = -(far + near) / (far - near);
    m(3, 3) = 1;
    return m;
  }
  const double near = std::max(along - reach, 0.005 * distance);
  const double far = std::max(along + reach, 2 * near);
  m(0, 0) = 1 / (half_height(*this) * aspect);
  m(1, 1) = 1 / half_height(*this);
  m(2, 2) = -(far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m(3, 2) = -1;
  return m;
}

Ray ViewCamera::ray(Vec2 pixel, ViewSize view) const {
  const double x = (pixel.x() - 0.5 * view.width) * pixel_size(view);
  const double y = (0.5 * view.height - pixel.y()) * pixel_size(view);
  const Vec3 through = target + x * right() + y * screen_up();
  Ray ray;
  if (orthographic) {
    ray.direction = -backward();
    ray.origin = through + distance * backward();
    ray.pixel_base = pixel_size(view);
  } else {
    ray.origin = eye();
    ray.direction = (through - ray.origin).normalized();
    ray.pixel = pixel_size(view) / distance;
  }
  return ray;
}

std::optional<Vec2> Projection::operator()(const Vec3& world) const {
  const Vec3 d = world - eye;
  const double ahead = -d.dot(backward);
  if (!orthographic && !(ahead > 1e-9 * distance)) return std::nullopt;
  const double size = orthographic ? pixel_size : pixel_size * ahead / distance;
  return Vec2(middle.x() + d.dot(right) / size, middle.y() - d.dot(screen_up) / size);
}

Projection ViewCamera::projection(ViewSize view) const {
  return {eye(),
          right(),
          screen_up(),
          backward(),
          distance,
          pixel_size(view),
          {0.5 * view.width, 0.5 * view.height},
          orthographic};
}

std::optional<Vec2> ViewCamera::project(const Vec3& world, ViewSize view) const {
  return projection(view)(world);
}

double ViewCamera::pixel_size(ViewSize view) const {
  return 2 * distance * half_height(*this) / std::max(view.height, 1.0);
}

ViewCamera initial_camera(const Mechanism& mechanism, const Bounds& bounds, ViewSize view) {
  ViewCamera camera;
  camera.up = up_axis(mechanism);
  if (mechanism.view.camera) {
    camera.target = mechanism.view.camera->target;
    camera.distance = mechanism.view.camera->distance;
    camera.azimuth = mechanism.view.camera->azimuth;
    camera.elevation = mechanism.view.camera->elevation;
  } else {
    camera.fit(bounds, view);
  }
  return camera;
}

} // namespace flyball
