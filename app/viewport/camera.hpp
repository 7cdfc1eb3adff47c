// The camera a person moves: a plain value that orbits a target. No OpenGL.
#pragma once

#include "app/viewport/bounds.hpp"

#include <Eigen/Core>

#include <optional>

namespace flyball {

using Vec2 = Eigen::Vector2d;
using Mat4 = Eigen::Matrix4d;

struct ViewSize {
  double width = 1, height = 1; // pixels
  bool operator==(const ViewSize&) const = default;
};

struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ(); // unit length
  double pixel = 0;               // m across one pixel, per m of the way along the ray
  double pixel_base = 0;          // m across one pixel at the origin
};

// The direction drawn upwards: against gravity, +y without gravity.
Vec3 up_axis(const Mechanism& mechanism);

// Where a camera puts points, for many of them: its axes are found once.
struct Projection {
  Vec3 eye = Vec3::Zero();                                                         // m
  Vec3 right = Vec3::UnitX(), screen_up = Vec3::UnitY(), backward = Vec3::UnitZ(); // unit vectors
  double distance = 1;        // m, from the eye to the target
  double pixel_size = 1;      // m across one pixel at the target
  Vec2 middle = Vec2::Zero(); // pixels
  bool orthographic = false;

  // The pixel a world point falls on; nothing where it is behind the eye.
  std::optional<Vec2> operator()(const Vec3& world) const;
};

// Pixels count from the top left corner of the view.
struct ViewCamera {
  Vec3 target = Vec3::Zero(); // m
  double distance = 1;        // m, from the eye to the target
  double azimuth = 0.45;      // rad about `up`; 0 with +y up looks from +z with +x to the right
  double elevation = 0.3;     // rad above the horizon
  Vec3 up = Vec3::UnitY();    // unit length
  double field_of_view = 0.5; // rad, vertical; an orthographic view shows the same height at the target
  bool orthographic = false;
  bool operator==(const ViewCamera&) const = default;

  Vec3 right() const; // unit vectors of the picture, in the world
  Vec3 screen_up() const;
  Vec3 backward() const; // from the target to the eye
  Vec3 eye() const;      // m

  void orbit(double dx, double dy, ViewSize view); // dragged by pixels: half a turn across the height
  void pan(double dx, double dy, ViewSize view);   // dragged by pixels: the target stays under the cursor
  void zoom(double factor, Vec2 cursor,
            ViewSize view); // factor > 1 comes closer; what is under the cursor stays
  void fit(const Bounds& bounds, ViewSize view, double margin = 1.15); // keeps the direction

  Mat4 view_matrix() const;
  // For OpenGL's clip space (z from -1 to 1). Nothing within `reach` (m) of `around` is clipped, unless it is
  // behind the eye.
  Mat4 projection_matrix(ViewSize view, const Vec3& around, double reach) const;

  Ray ray(Vec2 pixel, ViewSize view) const;
  Projection projection(ViewSize view) const;
  // Of a single point.
  std::optional<Vec2> project(const Vec3& world, ViewSize view) const;
  // Metres across one pixel at the target.
  double pixel_size(ViewSize view) const;
};

// The camera the scene file asks for, otherwise one that sees the whole mechanism (`bounds`) from the front.
ViewCamera initial_camera(const Mechanism& mechanism, const Bounds& bounds, ViewSize view);

} // namespace flyball
