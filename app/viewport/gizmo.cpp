#include "app/viewport/gizmo.hpp"

#include "app/viewport/work_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {

namespace {

// Points: where arrows begin and end, where patches begin and end along both their axes, the rings' radius.
constexpr double arrow_from = 12, arrow_to = 76, patch_from = 22, patch_to = 36, ring_radius = 68;
constexpr double shortest_arrow = 16; // points in the picture; a shorter one points at the viewer
constexpr double flattest_patch = 0.2, flattest_ring = 0.2; // sine of the angle between plane and view
constexpr int ring_steps = 72;
constexpr double line_reach = 6; // points around a line that still count as on it

constexpr std::array arrows{Handle::x, Handle::y, Handle::z};
constexpr std::array patches{Handle::yz, Handle::zx, Handle::xy};
constexpr std::array rings{Handle::ring_x, Handle::ring_y, Handle::ring_z};

Vec3 toward_eye(const Gizmo& gizmo) {
  return gizmo.camera.orthographic ? gizmo.camera.backward()
                                   : Vec3((gizmo.camera.eye() - gizmo.centre).normalized());
}

double distance_to_line(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

double distance_to(std::span<const Vec2> line, Vec2 p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i)
    nearest = std::min(nearest, distance_to_line(p, line[i - 1], line[i]));
  return nearest;
}

bool inside(std::span<const Vec2> corners, Vec2 p) {
  bool within = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec2 &a = corners[i], &b = corners[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      within = !within;
  }
  return within;
}

Vec2 mean(std::span<const Vec2> points) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : points)
    sum += p;
  return sum / static_cast<double>(points.size());
}

// Projects points given in the gizmo's own lengths (points of the picture).
class Projector {
 public:
  explicit Projector(const Gizmo& gizmo)
      : gizmo_(gizmo), unit_(gizmo.point * metres_per_pixel(gizmo.camera, gizmo.centre, gizmo.view)) {}
  std::optional<Vec2> operator()(const Vec3& offset) const {
    return gizmo_.camera.project(gizmo_.centre + unit_ * offset, gizmo_.view);
  }

 private:
  const Gizmo& gizmo_;
  double unit_;
};

void add_arrows(const Gizmo& gizmo, const Projector& project, std::vector<HandleShape>& shapes) {
  std::array<int, 3> order{0, 1, 2};
  const Vec3 near = toward_eye(gizmo);
  std::ranges::sort(order, {}, [&](int i) { return near[i]; });
  for (const int i : order) {
    const auto from = project(arrow_from * Vec3::Unit(i)), to = project(arrow_to * Vec3::Unit(i));
    if (!from || !to || (*to - *from).norm() < shortest_arrow * gizmo.point) continue;
    shapes.push_back({arrows[static_cast<std::size_t>(i)],
                      HandleForm::arrow,
                      {*from, *to},
                      {},
                      *from + 0.85 * (*to - *from)});
  }
}

void add_patches(const Gizmo& gizmo, const Projector& project, std::vector<HandleShape>& shapes) {
  const Vec3 near = toward_eye(gizmo);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(near[i]) < flattest_patch) continue;
    const Vec3 a = Vec3::Unit((i + 1) % 3), b = Vec3::Unit((i + 2) % 3);
    HandleShape shape{patches[static_cast<std::size_t>(i)], HandleForm::patch, {}, {}, {}};
    for (const auto& [u, v] : {std::pair(patch_from, patch_from), std::pair(patch_to, patch_from),
                               std::pair(patch_to, patch_to), std::pair(patch_from, patch_to)})
      if (const auto corner = project(u * a + v * b)) shape.line.push_back(*corner);
    if (shape.line.size() != 4) continue;
    shape.grip = mean(shape.line);
    shapes.push_back(std::move(shape));
  }
}

// The side that faces the viewer first; a ring seen from along its axis is near all round.
void add_ring(const Gizmo& gizmo, const Projector& project, int axis, std::vector<HandleShape>& shapes) {
  const Vec3 near = toward_eye(gizmo);
  const Vec3 n = Vec3::Unit(axis);
  HandleShape shape{rings[static_cast<std::size_t>(axis)], HandleForm::ring, {}, {}, {}};
  const Vec3 across = near - near[axis] * n;
  const bool flat = across.norm() < 0.1;
  const Vec3 front = flat ? Vec3(Vec3::Unit((axis + 1) % 3)) : Vec3(across.normalized());
  const Vec3 side = n.cross(front);
  for (int i = 0; i <= ring_steps; ++i) {
    const double angle = std::numbers::pi * (2.0 * i / ring_steps - 0.5);
    const auto p = project(ring_radius * (std::cos(angle) * front + std::sin(angle) * side));
    if (!p) return;
    const bool visible = flat || 2 * i <= ring_steps;
    if (visible) shape.line.push_back(*p);
    if (!visible || (!flat && 2 * i == ring_steps)) shape.far.push_back(*p);
  }
  shapes.push_back(std::move(shape));
}

// Where rings cross nobody knows which is meant.
void find_grips(std::vector<HandleShape>& shapes) {
  for (HandleShape& shape : shapes) {
    double widest = -1;
    for (const Vec2& p : shape.line) {
      double room = std::numeric_limits<double>::max();
      for (const HandleShape& other : shapes)
        if (other.handle != shape.handle) room = std::min(room, distance_to(other.line, p));
      if (room <= widest) continue;
      widest = room;
      shape.grip = p;
    }
  }
}

std::optional<double> along_line(const Vec3& origin, const Vec3& axis, const Ray& ray) {
  const double cosine = axis.dot(ray.direction), square = 1 - cosine * cosine;
  if (square < 1e-3) return std::nullopt;
  const Vec3 away = ray.origin - origin;
  const double at_line = (away.dot(axis) - cosine * away.dot(ray.direction)) / square;
  const double at_ray = (cosine * away.dot(axis) - away.dot(ray.direction)) / square;
  return at_ray > 0 ? std::optional(at_line) : std::nullopt;
}

} // namespace

std::string_view handle_name(Handle handle) {
  switch (handle) {
  case Handle::none: break;
  case Handle::x: return "x";
  case Handle::y: return "y";
  case Handle::z: return "z";
  case Handle::yz: return "yz";
  case Handle::zx: return "zx";
  case Handle::xy: return "xy";
  case Handle::plane: return "centre";
  case Handle::ring_x: return "ring/x";
  case Handle::ring_y: return "ring/y";
  case Handle::ring_z: return "ring/z";
  }
  return "";
}

bool is_ring(Handle handle) {
  return std::ranges::find(rings, handle) != rings.end();
}

int axis_of(Handle handle) {
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (handle == arrows[k] || handle == patches[k] || handle == rings[k]) return i;
  }
  return -1;
}

std::array<bool, 3> free_coordinates(Handle handle, int normal) {
  std::array<bool, 3> free{};
  const int axis = handle == Handle::plane ? normal : axis_of(handle);
  if (axis < 0 || is_ring(handle)) return free;
  const bool arrow = std::ranges::find(arrows, handle) != arrows.end();
  free.fill(!arrow);
  free[static_cast<std::size_t>(axis)] = arrow;
  return free;
}

std::vector<HandleShape> handle_shapes(const Gizmo& gizmo) {
  std::vector<HandleShape> shapes;
  const auto middle = gizmo.camera.project(gizmo.centre, gizmo.view);
  if (!middle) return shapes;
  const Projector project(gizmo);
  if (gizmo.kind == GizmoKind::rings) {
    for (int i = 0; i < 3; ++i)
      add_ring(gizmo, project, i, shapes);
    find_grips(shapes);
    return shapes;
  }
  add_patches(gizmo, project, shapes);
  add_arrows(gizmo, project, shapes);
  shapes.push_back({Handle::plane, HandleForm::ball, {*middle}, {}, *middle});
  return shapes;
}

Handle handle_at(const std::vector<HandleShape>& shapes, Vec2 cursor, double point) {
  Handle best = Handle::none;
  double nearest = line_reach * point;
  for (const HandleShape& shape : shapes) {
    double distance = std::numeric_limits<double>::infinity();
    switch (shape.form) {
    case HandleForm::ball:
      // On top of everything else.
      if ((cursor - shape.line[0]).norm() < (ball_radius + 2) * point) return shape.handle;
      break;
    case HandleForm::patch:
      // Behind the arrows.
      if (inside(shape.line, cursor)) distance = 0.6 * line_reach * point;
      break;
    case HandleForm::arrow:
    case HandleForm::ring: distance = distance_to(shape.line, cursor); break;
    }
    if (distance > nearest) continue;
    nearest = distance;
    best = shape.handle;
  }
  return best;
}

std::optional<Vec3> dragged(const Gizmo& gizmo, Handle handle, const Ray& from, const Ray& to) {
  const int axis = handle == Handle::plane ? gizmo.normal : axis_of(handle);
  if (axis < 0 || is_ring(handle)) return std::nullopt;
  if (handle == Handle::x || handle == Handle::y || handle == Handle::z) {
    const Vec3 unit = Vec3::Unit(axis);
    const auto a = along_line(gizmo.centre, unit, from), b = along_line(gizmo.centre, unit, to);
    return a && b ? std::optional<Vec3>((*b - *a) * unit) : std::nullopt;
  }
  const WorkPlane plane{gizmo.centre, axis};
  const auto a = meet(plane, from), b = meet(plane, to);
  if (!a || !b) return std::nullopt;
  Vec3 by = *b - *a;
  by[axis] = 0; // not even by round-off
  return by;
}

std::optional<double> turned(const Gizmo& gizmo, Handle ring, const Ray& from, const Ray& to) {
  if (!is_ring(ring)) return std::nullopt;
  const int axis = axis_of(ring);
  const Vec3 n = Vec3::Unit(axis), near = toward_eye(gizmo);
  const WorkPlane plane{gizmo.centre, axis};
  const auto a = meet(plane, from), b = meet(plane, to);
  if (std::abs(near[axis]) > flattest_ring && a && b) {
    const Vec3 p = *a - gizmo.centre, q = *b - gizmo.centre;
    return std::atan2(n.dot(p.cross(q)), p.dot(q));
  }
  // Seen from the side: as far as the cursor goes along it.
  const double radius = ring_radius * gizmo.point * metres_per_pixel(gizmo.camera, gizmo.centre, gizmo.view);
  const Vec3 along = n.cross(near).normalized();
  const auto at = [&](const Ray& ray) {
    const double far = near.dot(gizmo.centre - ray.origin) / near.dot(ray.direction);
    return along.dot(ray.origin + far * ray.direction - gizmo.centre);
  };
  return std::remainder((at(to) - at(from)) / radius, 2 * std::numbers::pi);
}

} // namespace flyball
