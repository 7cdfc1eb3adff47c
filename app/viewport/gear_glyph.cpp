// Gears as toothed wheels that mesh, or as signs that dots tie; belts as loops around their wheels, racks
// with their pinion, screws as a thread along the slide.
#include "app/viewport/glyphs.hpp"
#include "engine/mechanism/gear_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

// Where one of its coordinates is.
struct GearEnd {
  Vec3 at, there, axis; // m, world, as carried by the parent and by the child; unit length
};

std::optional<GearEnd> gear_end(const Assembly& assembly, const std::string& name) {
  const auto [j, i] = find_coordinate(assembly.mechanism, name);
  if (j < 0) return {};
  const Joint& joint = assembly.joint(j);
  const auto [parent, child] = assembly.joint_bodies[static_cast<std::size_t>(j)];
  const CoordinateAxis along = coordinate_axis(joint, static_cast<std::size_t>(i));
  const int carrier = along.end == 0 ? parent : child;
  return GearEnd{assembly.point(parent, joint.at), assembly.point(child, joint.at),
                 assembly.vector(carrier, along.axis)};
}

// Dots tell which two joints move together.
void draw_dots(Sketch& sketch, const Vec3& from, const Vec3& to, double u) {
  const int dots = std::clamp(static_cast<int>((to - from).norm() / (1.3 * u)), 0, 60);
  for (int i = 1; i < dots; ++i)
    sketch.sphere(from + (to - from) * (double(i) / dots), 0.2 * u);
}

// The straight parts touch both wheels at angles to the line of centres whose cosine is the difference, or if
// crossed the sum, of the radii by the distance. Crossed where the wheels turn against each other in space.
// False where there is no such loop.
bool draw_belt(Sketch& sketch, const Mechanism& mechanism, const Joint& belt, const GearEnd& a,
               const GearEnd& b, double u, const Palette& colors) {
  const bool crossed = belt.crossed == wheels_turn_alike(mechanism, belt);
  const double parallel = a.axis.dot(b.axis), sum = belt.radii[0] + (crossed ? 1 : -1) * belt.radii[1];
  const Vec3 center_a = a.at + 1.7 * u * a.axis;
  const Vec3 center_b = b.at + a.axis * a.axis.dot(center_a - b.at); // in the plane of the first wheel
  const Vec3 line = center_b - center_a;
  const double distance = line.stableNorm();
  if (!(std::abs(parallel) > 0.99) || !(distance > std::abs(sum))) return false;
  const Vec3 along = line / distance, across = a.axis.cross(along);
  const double wire = 0.2 * u;
  for (const auto& [center, radius] : {std::pair(center_a, belt.radii[0]), {center_b, belt.radii[1]}}) {
    sketch.pen.color = colors.metal;
    sketch.disc(center, a.axis, 0.3 * u, radius, 0.1 * u);
    sketch.pen.color = colors.metal_dark;
    sketch.ring(center, a.axis, radius, wire, false);
  }
  const double cosine = sum / distance, sine = std::sqrt(1 - cosine * cosine);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 out = cosine * along + side * sine * across;
    sketch.rod(center_a + belt.radii[0] * out, center_b + (crossed ? -1 : 1) * belt.radii[1] * out, wire);
  }
  return true;
}

// The rack runs where the pinion's rim moves along the slide, and goes with what slides; it reaches as far as
// it takes to stay in mesh.
void draw_rack(Sketch& sketch, double radius, const GearEnd& a, const GearEnd& b, double u,
               const Palette& colors) {
  const Vec3 center = a.at + 1.7 * u * a.axis;
  const double size = std::max(std::abs(radius), 1.5 * u);
  sketch.pen.color = colors.metal_dark;
  sketch.gear(center, a.axis, 0.28 * u, size);
  const Vec3 out = b.axis.cross(a.axis);
  if (!(out.stableNorm() > 0.9)) return draw_dots(sketch, center, b.there, u);
  const Vec3 contact = center + std::copysign(size + 0.45 * u, radius) * out.stableNormalized();
  const double gone = b.axis.dot(b.there - b.at); // m, since the drawn pose
  const double low = std::min(gone - 1.8 * size, -0.3 * size), high = std::max(gone + 1.8 * size, 0.3 * size);
  sketch.pen.color = colors.metal;
  sketch.box(contact + (low + high) / 2 * b.axis, frame_along(b.axis, out),
             {0.45 * u, 0.28 * u, (high - low) / 2}, 0.08 * u);
}

// A rim that leaves what turns with it to be seen, and its teeth.
void draw_wheel(Sketch& sketch, const Assembly& assembly, const ToothedWheel& wheel) {
  const double u = assembly.scale.unit;
  const Vec3 center = assembly.point(wheel.body, wheel.center),
             axis = assembly.vector(wheel.body, wheel.axis), x = assembly.vector(wheel.body, wheel.to_tooth),
             y = axis.cross(x);
  const double pitch = 2 * std::numbers::pi * wheel.radius / wheel.teeth;
  const double tip = 0.3 * pitch, wire = std::min(0.28 * u, 0.2 * wheel.radius);
  const double out = wheel.inside ? -1 : 1, rim = wheel.radius - out * (tip + wire);
  sketch.ring(center, axis, rim, wire, false);
  for (int i = 0; i < wheel.teeth; ++i) {
    const double angle = 2 * std::numbers::pi * i / wheel.teeth;
    const Vec3 to = std::cos(angle) * x + std::sin(angle) * y;
    sketch.box(center + (wheel.radius - 0.5 * out * wire) * to, frame_along(axis, to),
               {tip + 0.5 * wire, 0.23 * pitch, wire}, 0.03 * pitch);
  }
}

void draw_screw(Sketch& sketch, const GearEnd& a, const GearEnd& b, double u, const Palette& colors) {
  sketch.pen.color = colors.metal_dark;
  sketch.coil(b.there - 3 * u * b.axis, b.there + 3 * u * b.axis, b.axis.unitOrthogonal(), 0.8 * u, 0.22 * u,
              false);
  draw_dots(sketch, a.at, b.there, u);
}

} // namespace

void draw_gear(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& gear = assembly.mechanism.joints[index];
  const double u = assembly.scale.unit;
  const auto a = gear_end(assembly, gear.joints[0]), b = gear_end(assembly, gear.joints[1]);
  if (!a || !b) return;
  if (gear.kind == GearKind::belt && draw_belt(sketch, assembly.mechanism, gear, *a, *b, u, colors)) return;
  if (gear.kind == GearKind::rack) return draw_rack(sketch, gear.radii[0], *a, *b, u, colors);
  if (gear.kind == GearKind::screw) return draw_screw(sketch, *a, *b, u, colors);
  sketch.pen.color = colors.metal_dark;
  if (const auto& wheels = assembly.wheels[index]; wheels[0].radius > 0) {
    for (const ToothedWheel& wheel : wheels)
      if (wheel.is_first) draw_wheel(sketch, assembly, wheel);
    return;
  }
  // Bevel gears and the like: a sign on each axis.
  const Vec3 at_a = a->at + 1.7 * u * a->axis, at_b = b->at + 1.7 * u * b->axis;
  sketch.gear(at_a, a->axis, 0.28 * u, 2.1 * u);
  sketch.gear(at_b, b->axis, 0.28 * u, 2.1 * u);
  draw_dots(sketch, at_a, at_b, u);
}

} // namespace flyball
