#include "app/viewport/glyphs.hpp"

#include "engine/mechanism/bearing_axes.hpp"
#include "engine/mechanism/damped.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// Grey when slack, fully coloured when stretched or pressed by `full` or more.
Color spring_color(const Palette& colors, double stretch, double full) {
  const double t = std::isfinite(stretch) && full > 0 ? std::clamp(std::abs(stretch) / full, 0.0, 1.0) : 0;
  return mix(colors.slack, stretch > 0 ? colors.tension : colors.compression,
             static_cast<float>(std::sqrt(t)));
}

// Across `axis`, to the side where the mechanism takes least space.
Vec3 free_side(const Assembly& assembly, const Vec3& axis) {
  const Vec3 size = assembly.scale.bounds.upper - assembly.scale.bounds.lower;
  int best = -1;
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) < 0.9 && (best < 0 || size[i] <= size[best])) best = i;
  const Vec3 seed = Vec3::Unit(std::max(best, 0));
  return (seed - axis * axis.dot(seed)).stableNormalized();
}

// A cylinder held at `from` and a rod held at `to`, beside the line between them.
void draw_dashpot(Sketch& sketch, const Vec3& from, const Vec3& to, const Vec3& offset, double cylinder,
                  double u, const Palette& colors) {
  const Vec3 a = from + offset, b = to + offset;
  const Vec3 along = b - a;
  const double length = along.stableNorm();
  if (!(length > 0)) return;
  const Vec3 dir = along / length;
  const double reach = std::clamp(cylinder, 0.2 * length, 0.8 * length);
  sketch.pen.color = colors.metal_dark;
  sketch.cylinder(a + 0.12 * reach * dir, a + reach * dir, 0.62 * u, 0.12 * u);
  sketch.pen.color = colors.metal;
  sketch.rod(a, b, 0.2 * u);
  if (offset.norm() > 0.1 * u) {
    sketch.rod(from, a, 0.2 * u);
    sketch.rod(to, b, 0.2 * u);
  }
}

// Whether something of the body (-1: ground) is drawn about a point already, so that a coil may end there.
bool ends_at_part(const Assembly& assembly, int body, const Vec3& at, std::size_t slide) {
  if (body < 0) return false;
  const auto& attachments = assembly.attachments[static_cast<std::size_t>(body)];
  return std::any_of(attachments.begin(), attachments.end(), [&](const Attachment& a) {
    return a.joint != static_cast<int>(slide) &&
           (assembly.point(body, a.at) - at).norm() < 2 * assembly.scale.unit;
  });
}

void draw_slide_forces(Sketch& sketch, const Assembly& assembly, std::size_t index, std::size_t i,
                       const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  const Coordinate& c = joint.coordinates[i];
  const auto [parent, child] = assembly.joint_bodies[index];
  const double u = assembly.scale.unit;
  const bool rails = joint.type == JointType::prismatic || joint.type == JointType::cylindrical;
  const bool child_slides = !rails || slider_end(assembly, index) == 1;
  const int slider = child_slides ? child : parent, rail = child_slides ? parent : child;
  const Vec3 axis = (child_slides ? 1 : -1) * assembly.vector(parent, coordinate_axis(joint, i).axis);
  const SlideRange range = slide_range(assembly, index, i);
  const double value = coordinate_value(assembly, index, i);
  // The bodies may stand apart in the other directions of a planar or free joint; the spring's end stays with
  // what slides.
  const Vec3 end = assembly.point(slider, joint.at);
  const Vec3 start = end + (range.anchor - value) * axis;
  const double side = value > range.anchor ? 1 : -1;
  const Vec3 across = assembly.vector(parent, free_side(assembly, coordinate_axis(joint, i).axis));
  if (c.spring) {
    sketch.pen.role = Role::spring;
    sketch.pen.color = spring_color(colors, side * (value - c.spring->free),
                                    std::max(0.15 * std::abs(c.spring->free - range.anchor), 1e-9 * u));
    sketch.coil(start, end - 1.5 * side * u * axis, across, 1.25 * u, 0.2 * u, true);
  }
  if (is_damped(c)) {
    sketch.pen.role = Role::damper;
    const double inset = std::min(2.2 * u, 0.2 * std::abs(value - range.anchor));
    draw_dashpot(sketch, start + side * inset * axis, end, 2.5 * u * across,
                 0.6 * std::abs(c.drawn - range.anchor), u, colors);
  }
  // Ground's own plate ends the rail of a slide, which may go on beyond the spring.
  const bool ends_there = range.anchor == range.from || range.anchor == range.to;
  if ((rails && rail < 0 && ends_there) || ends_at_part(assembly, rail, start, index)) return;
  sketch.pen.color = colors.metal_dark;
  sketch.disc(start, axis, 0.25 * u, 1.7 * u, 0.1 * u);
}

void draw_turn_forces(Sketch& sketch, const Assembly& assembly, std::size_t index, std::size_t i,
                      const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  const Coordinate& c = joint.coordinates[i];
  const auto [parent, child] = assembly.joint_bodies[index];
  const double u = assembly.scale.unit;
  const CoordinateAxis along = coordinate_axis(joint, i);
  const Vec3 axis = assembly.vector(along.end == 0 ? parent : child, along.axis);
  const Vec3 at = assembly.point(parent, joint.at);
  if (c.spring) {
    sketch.pen.role = Role::spring;
    sketch.pen.color = spring_color(colors, coordinate_value(assembly, index, i) - c.spring->free, 0.6);
    sketch.spiral(at + 1.5 * u * axis, axis, assembly.vector(child, along.axis.unitOrthogonal()), 1.9 * u,
                  0.14 * u);
  }
  if (is_damped(c)) {
    sketch.pen.role = Role::damper;
    sketch.pen.color = colors.metal_dark;
    sketch.disc(at - 1.25 * u * axis, axis, 0.3 * u, 1.25 * u, 0.1 * u);
  }
}

void draw_spring(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Force& force = assembly.mechanism.forces[index];
  const auto [first, second] = assembly.force_bodies[index];
  const double u = assembly.scale.unit;
  const Vec3 a = assembly.point(first, force.points[0]), b = assembly.point(second, force.points[1]);
  const double drawn = (force.points[1] - force.points[0]).stableNorm(), length = (b - a).stableNorm();
  const double free = force.free_length.value_or(drawn);
  const Vec3 side = length > 0 ? free_side(assembly, (b - a) / length) : Vec3(Vec3::UnitX());
  if (!is_damper_alone(force)) {
    sketch.pen.role = Role::spring;
    sketch.pen.color = spring_color(colors, length - free, std::max(0.15 * free, 1e-9 * u));
    sketch.coil(a, b, side, std::min(1.1 * u, 0.2 * drawn), std::min(0.18 * u, 0.035 * drawn), false);
  }
  if (is_damped(force)) {
    sketch.pen.role = Role::damper;
    draw_dashpot(sketch, a, b, !is_damper_alone(force) ? Vec3(2.2 * u * side) : Vec3(Vec3::Zero()),
                 0.6 * drawn, u, colors);
  }
  sketch.pen.role = Role::force;
  sketch.pen.color = colors.metal_dark;
  for (const auto& [body, end] : {std::pair(first, a), std::pair(second, b)})
    if (!within_ball(assembly, body, end, 0.45 * u)) sketch.sphere(end, 0.45 * u);
  if (first < 0) draw_anchor(sketch, a, b - a, 1.5 * u, u, colors);
  if (second < 0) draw_anchor(sketch, b, a - b, 1.5 * u, u, colors);
}

// Arrows grow with the square root of what they stand for, the largest of its kind being ten units long.
double arrow_length(const Assembly& assembly, const Force& force) {
  const double largest = assembly.largest_vectors[static_cast<std::size_t>(force.type)];
  const double share = largest > 0 ? force.vector.stableNorm() / largest : 0;
  return assembly.scale.unit * (4 + 6 * std::sqrt(share));
}

} // namespace

void draw_joint_forces(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  sketch.pen = {colors.metal, Surface::metal, Role::spring, {PartKind::joint, static_cast<int>(index)}};
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
    if (!joint.coordinates[i].spring && !is_damped(joint.coordinates[i])) continue;
    if (coordinate_axis(joint, i).angle)
      draw_turn_forces(sketch, assembly, index, i, colors);
    else
      draw_slide_forces(sketch, assembly, index, i, colors);
  }
}

namespace {

// A sleeve round the shaft, hung on four springs in a ring that the first body holds.
void draw_bearing(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Force& force = assembly.mechanism.forces[index];
  const auto [first, second] = assembly.force_bodies[index];
  const double u = assembly.scale.unit;
  const Mat3 drawn = bearing_axes(force);
  const Vec3 point = force.at.value_or(Vec3::Zero());
  const Vec3 at = assembly.point(second, point), middle = assembly.point(first, point);
  const Vec3 axis = assembly.vector(first, drawn.col(2));
  const Vec3 x = assembly.vector(first, drawn.col(0)), y = assembly.vector(first, drawn.col(1));
  const double sleeve = 1.8 * u, ring = 4 * u;
  sketch.pen.color = colors.metal;
  sketch.tube(at, axis, 0.9 * u, sleeve, 0.15 * u);
  sketch.pen.color = colors.metal_dark;
  sketch.ring(middle, axis, ring, 0.4 * u, false);
  sketch.pen.role = Role::spring;
  sketch.pen.color = colors.slack;
  for (const Vec3& out : {x, y, Vec3(-x), Vec3(-y)})
    sketch.coil(at + sleeve * out, middle + ring * out, axis, 0.55 * u, 0.14 * u, false);
  if (first < 0) {
    sketch.pen.role = Role::force;
    const Vec3 up = assembly.scale.up - axis * axis.dot(assembly.scale.up);
    const Vec3 out = up.norm() > 0.1 ? Vec3(-up.normalized()) : Vec3(-y); // down, where that is across
    draw_anchor(sketch, middle + (ring + 0.6 * u) * out, out, 1.5 * u, u, colors);
  }
}

// The place on an axis through a point (m, world) where a torque's arc is seen: before the body's shapes, on
// the side that is to the front.
Vec3 before_shapes(const Assembly& assembly, int index, const Vec3& at, const Vec3& axis) {
  const auto b = static_cast<std::size_t>(index);
  const Body& body = assembly.mechanism.bodies[b];
  const Bounds bounds = shape_bounds(body);
  if (bounds.empty) return at;
  const Vec3 out = axis.dot(Vec3(0.5, 0.3, 0.8)) < 0 ? Vec3(-axis) : axis;
  const Quat turn = assembly.poses[b].rotation * body.rotation.normalized().conjugate();
  const Vec3 drawn = turn.conjugate() * out;
  const Vec3 middle = assembly.point(index, bounds.center()) - at;
  const double reach = out.dot(middle) + drawn.cwiseAbs().dot(0.5 * (bounds.upper - bounds.lower));
  return at + (std::max(reach, 0.0) + 0.8 * assembly.scale.unit) * out;
}

} // namespace

void draw_force(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Force& force = assembly.mechanism.forces[index];
  sketch.pen = {colors.force, Surface::metal, Role::force, {PartKind::force, static_cast<int>(index)}};
  if (force.type == ForceType::spring) return draw_spring(sketch, assembly, index, colors);
  if (force.type == ForceType::bearing) return draw_bearing(sketch, assembly, index, colors);
  const int body = assembly.force_bodies[index][0];
  if (body < 0) return;
  const double u = assembly.scale.unit;
  const Vec3 at = assembly.point(
      body, force.at.value_or(assembly.mechanism.bodies[static_cast<std::size_t>(body)].position));
  if (force.type == ForceType::drag) {
    // A cup that catches the air.
    sketch.pen.color = colors.slack;
    return sketch.bowl(at, assembly.scale.up.unitOrthogonal(), 2.4 * u);
  }
  if (force.type == ForceType::vane) {
    const Vec3 normal = assembly.vector(body, force.normal.stableNormalized()),
               chord = assembly.vector(body, force.chord.value_or(force.normal.unitOrthogonal()));
    const double side = 0.5 * std::sqrt(std::max(force.area, 0.0));
    sketch.pen.color = colors.slack;
    return sketch.box(at, frame_along(normal, chord), {std::max(side, u), std::max(side, u), 0.12 * u},
                      0.05 * u);
  }
  const Vec3 vector = force.frame == ForceFrame::world
                          ? force.vector
                          : Vec3(assembly.poses[static_cast<std::size_t>(body)].rotation * force.vector);
  if (!(vector.stableNorm() > 0)) return;
  const Vec3 dir = vector.stableNormalized();
  const double length = arrow_length(assembly, force);
  if (force.type == ForceType::force) return sketch.arrow(at, at + length * dir, 0.28 * u);
  const Vec3 arc = before_shapes(assembly, body, at, dir);
  sketch.turn(arc, dir, dir.unitOrthogonal(), 0.35 * length, 0.24 * u);
  sketch.arrow(arc - 0.3 * length * dir, arc + 0.5 * length * dir, 0.2 * u);
}

} // namespace flyball
