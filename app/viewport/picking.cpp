#include "app/viewport/picking.hpp"

#include "app/viewport/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

double box_distance(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double cylinder_distance(const Vec3& p, double radius, double half) {
  const double across = std::hypot(p.x(), p.y()) - radius, along = std::abs(p.z()) - half;
  return std::min(std::max(across, along), 0.0) + std::hypot(std::max(across, 0.0), std::max(along, 0.0));
}

double tube_distance(const Vec3& p, double radius, double hole, double half) {
  const double middle = 0.5 * (radius + hole);
  const double across = std::abs(std::hypot(p.x(), p.y()) - middle) - 0.5 * (radius - hole);
  const double along = std::abs(p.z()) - half;
  return std::min(std::max(across, along), 0.0) + std::hypot(std::max(across, 0.0), std::max(along, 0.0));
}

double ring_distance(const Vec3& p, double radius) {
  return std::hypot(std::hypot(p.x(), p.y()) - radius, p.z());
}

} // namespace

// One can point at coils between the turns.
double surface_distance(const Instance& instance, const Vec3& point) {
  const Vec3 p = instance.rotation.conjugate() * (point - instance.position);
  const Vec3& e = instance.extent;
  const double r = instance.round;
  switch (instance.primitive) {
  case Primitive::sphere: return p.norm() - r;
  case Primitive::capsule: return Vec3(p.x(), p.y(), p.z() - std::clamp(p.z(), -e.z(), e.z())).norm() - r;
  case Primitive::box: return box_distance(p, e) - r;
  case Primitive::tube: return tube_distance(p, e.x(), tube_hole * e.x(), e.z()) - r;
  case Primitive::cylinder:
  case Primitive::gear: return cylinder_distance(p, e.x(), e.z()) - r;
  case Primitive::spiral: return cylinder_distance(p, e.x(), 0) - r;
  case Primitive::ring:
  case Primitive::arc:
  case Primitive::broken_ring: return ring_distance(p, e.x()) - r;
  case Primitive::coil:
  case Primitive::open_coil: return cylinder_distance(p - Vec3(0, 0, 0.5 * e.z()), e.x(), 0.5 * e.z()) - r;
  case Primitive::cone: return cylinder_distance(p - Vec3(0, 0, 0.5 * e.z()), 0.5 * e.x(), 0.5 * e.z()) - r;
  case Primitive::bowl: return std::max(p.norm() - e.x(), p.z()) - r;
  }
  return std::numeric_limits<double>::infinity();
}

namespace {

struct Pass {
  double along = 0; // m, where the ray is nearest to the surface, or where it meets it
  double gap = 0;   // pixels that it passes by; 0 where it meets it
};

// Walks along the ray by the distance that is surely free (sphere tracing).
std::optional<Pass> pass_by(const Instance& instance, const Ray& ray, double slack) {
  const auto pixel = [&](double along) { return ray.pixel_base + ray.pixel * std::max(along, 0.0); };
  // Most instances are nowhere near: a ball round each tells soonest.
  const double reach = instance.extent.norm() + instance.round;
  const double toward = ray.direction.dot(instance.position - ray.origin);
  const double aside = (ray.origin + toward * ray.direction - instance.position).norm();
  if (toward + reach < 0 || aside > reach + slack * pixel(toward + reach)) return std::nullopt;
  const Bounds box = instance_bounds(instance);
  const double radius = box.radius();
  const double middle = ray.direction.dot(box.center() - ray.origin);
  const double gap = (ray.origin + middle * ray.direction - box.center()).norm();
  if (middle + radius < 0 || gap > radius + slack * pixel(middle + radius)) return std::nullopt;
  Pass nearest{0, std::numeric_limits<double>::infinity()};
  double along = std::max(middle - 1.01 * radius, 0.0);
  for (int step = 0; step < 200 && along <= middle + 1.01 * radius; ++step) {
    const double distance = surface_distance(instance, ray.origin + along * ray.direction);
    const double fine = 0.02 * pixel(along) + 1e-9 * radius;
    if (distance < fine) return Pass{along, 0};
    if (pixel(along) > 0 && distance / pixel(along) < nearest.gap) nearest = {along, distance / pixel(along)};
    along += std::max(distance, fine);
  }
  if (nearest.gap > slack) return std::nullopt;
  return nearest;
}

} // namespace

std::optional<Hit> pick(std::span<const Instance> instances, const Ray& ray, double slack) {
  const Instance* best = nullptr;
  Pass best_pass;
  for (const Instance& instance : instances) {
    if (instance.part.kind == PartKind::none) continue;
    const auto pass = pass_by(instance, ray, slack);
    if (!pass) continue;
    const bool nearer =
        pass->gap < best_pass.gap || (pass->gap == best_pass.gap && pass->along < best_pass.along);
    if (best && !nearer) continue;
    best = &instance;
    best_pass = *pass;
  }
  if (!best) return std::nullopt;
  return Hit{best->part, best_pass.along, ray.origin + best_pass.along * ray.direction,
             static_cast<std::size_t>(best - instances.data())};
}

} // namespace flyball
