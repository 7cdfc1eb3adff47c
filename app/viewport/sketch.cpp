#include "app/viewport/sketch.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

Quat frame_along(const Vec3& z) {
  return frame_along(z, z.unitOrthogonal());
}

Quat frame_along(const Vec3& z, const Vec3& x) {
  const Vec3 c = z.stableNormalized();
  Vec3 a = x - c * c.dot(x);
  if (!(a.norm() > 1e-9 * x.norm())) a = c.unitOrthogonal();
  a.normalize();
  Mat3 m;
  m << a, c.cross(a), c;
  return Quat(m);
}

void Sketch::add(Primitive primitive, const Vec3& position, const Quat& rotation, const Vec3& extent,
                 double round) {
  if (!position.allFinite() || !rotation.coeffs().allFinite() || !extent.allFinite() || !std::isfinite(round))
    return;
  list_->push_back(
      {primitive, position, rotation, extent, round, pen.color, pen.surface, pen.role, pen.part});
}

void Sketch::sphere(const Vec3& center, double radius) {
  add(Primitive::sphere, center, Quat::Identity(), Vec3::Zero(), radius);
}

void Sketch::rod(const Vec3& from, const Vec3& to, double radius) {
  const Vec3 along = to - from;
  const double length = along.stableNorm();
  if (!(length > 1e-6 * radius)) return sphere(from, radius);
  add(Primitive::capsule, 0.5 * from + 0.5 * to, frame_along(along), {0, 0, 0.5 * length}, radius);
}

void Sketch::cylinder(const Vec3& from, const Vec3& to, double radius, double edge) {
  disc(0.5 * from + 0.5 * to, to - from, 0.5 * (to - from).stableNorm(), radius, edge);
}

void Sketch::disc(const Vec3& center, const Vec3& axis, double half, double radius, double edge) {
  const double e = std::min({edge, half, radius});
  add(Primitive::cylinder, center, frame_along(axis), {radius - e, radius - e, half - e}, e);
}

void Sketch::tube(const Vec3& center, const Vec3& axis, double half, double radius, double edge) {
  const double e = std::min({edge, half, 0.15 * radius});
  add(Primitive::tube, center, frame_along(axis), {radius - e, radius - e, half - e}, e);
}

void Sketch::box(const Vec3& center, const Quat& frame, const Vec3& half, double edge) {
  const double e = std::min(edge, half.minCoeff());
  add(Primitive::box, center, frame, half.array() - e, e);
}

void Sketch::cone(const Vec3& base, const Vec3& direction, double radius, double length) {
  add(Primitive::cone, base, frame_along(direction), {radius, radius, length}, 0);
}

void Sketch::arrow(const Vec3& from, const Vec3& to, double radius) {
  const Vec3 along = to - from;
  const double length = along.stableNorm();
  if (!(length > 0)) return;
  const double head = std::min(6 * radius, 0.6 * length);
  const Vec3 neck = to - along * (head / length);
  rod(from, neck, radius);
  cone(neck, along, 0.42 * head, head);
}

void Sketch::bowl(const Vec3& center, const Vec3& bottom, double radius) {
  add(Primitive::bowl, center, frame_along(-bottom), Vec3::Constant(radius), 0);
}

void Sketch::ring(const Vec3& center, const Vec3& axis, double radius, double wire, bool broken) {
  add(broken ? Primitive::broken_ring : Primitive::ring, center, frame_along(axis), Vec3::Constant(radius),
      wire);
}

void Sketch::turn(const Vec3& center, const Vec3& axis, const Vec3& start, double radius, double wire) {
  const Quat frame = frame_along(axis, start);
  add(Primitive::arc, center, frame, Vec3::Constant(radius), wire);
  cone(center + frame * Vec3(-0.1 * radius, -radius, 0), frame * Vec3(1, 0.12, 0), 2.6 * wire, 7 * wire);
}

void Sketch::coil(const Vec3& from, const Vec3& to, const Vec3& start, double radius, double wire,
                  bool open) {
  const Vec3 along = to - from;
  const double length = along.stableNorm();
  if (!(length > 0)) return;
  add(open ? Primitive::open_coil : Primitive::coil, from, frame_along(along, start),
      {radius, radius, length}, wire);
}

void Sketch::spiral(const Vec3& center, const Vec3& axis, const Vec3& end, double radius, double wire) {
  add(Primitive::spiral, center, frame_along(axis, end), Vec3::Constant(radius), wire);
}

void Sketch::gear(const Vec3& center, const Vec3& axis, double half, double radius) {
  add(Primitive::gear, center, frame_along(axis), {radius, radius, half}, 0);
}

} // namespace flyball
