#include "app/viewport/glyphs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace flyball {

namespace {

struct Place {
  int parent = -1, child = -1;
  Vec3 at;          // m, world, as carried by the parent
  Vec3 there;       // the same as carried by the child
  Vec3 axis, axis2; // unit length, world
  double unit = 0;
};

Place place_of(const Assembly& assembly, std::size_t index) {
  const Joint& joint = assembly.mechanism.joints[index];
  Place p;
  p.parent = assembly.joint_bodies[index][0];
  p.child = assembly.joint_bodies[index][1];
  p.at = assembly.point(p.parent, joint.at);
  p.there = assembly.point(p.child, joint.at);
  p.axis = assembly.vector(p.parent, coordinate_axis(joint, 0).axis);
  if (joint.type == JointType::planar) p.axis = assembly.vector(p.parent, joint.axis.stableNormalized());
  p.axis2 = assembly.vector(joint.type == JointType::universal ? p.child : p.parent,
                            joint.axis2.stableNormalized());
  p.unit = assembly.scale.unit;
  return p;
}

// Half the thickness of an anchor's plate.
double anchor_half(double radius, double unit) {
  return std::min(0.16 * radius, 0.45 * unit);
}

// The side of a joint at which ground holds it: below if the axis leans upwards, otherwise behind.
Vec3 ground_side(const Vec3& axis, const Vec3& up) {
  return axis.dot(up) < -0.3 ? axis : Vec3(-axis);
}

// Hinges on one pin stand side by side: which of how many this one is.
struct Rank {
  int index = 0, count = 1;
};

Rank rank_on_pin(const Assembly& assembly, std::size_t index) {
  const Joint& joint = assembly.mechanism.joints[index];
  const auto [parent, child] = assembly.joint_bodies[index];
  const int body = parent >= 0 ? parent : child;
  Rank rank{0, 0};
  constexpr std::size_t most = 200; // that anybody could tell apart
  if (body < 0 || assembly.attachments[static_cast<std::size_t>(body)].size() > most) return {};
  for (const Attachment& a : assembly.attachments[static_cast<std::size_t>(body)]) {
    if (a.joint < 0) continue;
    const Joint& other = assembly.joint(a.joint);
    if (other.type != JointType::revolute || (other.at - joint.at).norm() > 0.5 * assembly.scale.unit ||
        other.axis.stableNormalized().cross(joint.axis.stableNormalized()).norm() > 0.1)
      continue;
    if (a.joint < static_cast<int>(index)) ++rank.index;
    ++rank.count;
  }
  return rank;
}

// How far the discs that a hinge's pin goes through as their axle reach to either side of it (m).
double wheel_half(const Assembly& assembly, std::size_t index) {
  const Joint& joint = assembly.mechanism.joints[index];
  const Vec3 axis = joint.axis.stableNormalized();
  double half = 0;
  for (const int body : assembly.joint_bodies[index]) {
    if (body < 0) continue;
    for (const Shape& shape : assembly.mechanism.bodies[static_cast<std::size_t>(body)].shapes) {
      const Vec3 line = shape.to - shape.from, off = joint.at - (shape.from + shape.to) / 2;
      const double along = std::abs(off.dot(axis)), reach = line.norm() / 2;
      if (shape.type != ShapeType::cylinder || reach > shape.radius || along > reach ||
          line.cross(axis).norm() > 0.1 * line.norm() || off.cross(axis).norm() > shape.radius)
        continue;
      half = std::max(half, along + reach);
    }
  }
  return half;
}

void draw_revolute(Sketch& sketch, const Assembly& assembly, std::size_t index, const Place& p,
                   const Palette& colors) {
  const double u = p.unit;
  const bool on_ground = p.parent < 0 || p.child < 0;
  for (const int body : {p.parent, p.child}) {
    const auto shaft = shaft_of(assembly, body);
    if (!shaft || shaft->joint != static_cast<int>(index)) continue;
    // A shaft stands in its bearing at its lower end.
    const Vec3 foot = shaft->origin + shaft->from * shaft->direction;
    sketch.pen.color = colors.metal;
    if (assembly.mechanism.bodies[static_cast<std::size_t>(body)].shapes.empty())
      sketch.tube(foot + 1.0 * u * shaft->direction, shaft->direction, 0.95 * u, 1.35 * u, 0.2 * u);
    const double radius = std::max(2.7 * u, 0.85 * shaft->base);
    return draw_anchor(sketch, foot - anchor_half(radius, u) * shaft->direction, shaft->direction, radius, u,
                       colors);
  }
  for (const int body : {p.parent, p.child}) {
    const auto shaft = shaft_of(assembly, body);
    if (!shaft || !on_axis(*shaft, assembly.mechanism.joints[index].at, u)) continue;
    // The shaft's head is the knuckle already.
    sketch.pen.color = colors.metal_dark;
    return sketch.disc(p.at, p.axis, 1.75 * u, 0.62 * u, 0.2 * u);
  }
  const Rank rank = rank_on_pin(assembly, index);
  const double half = rank.count > 1 ? 0.5 * u : 0.8 * u;
  const Vec3 knuckle = p.at + (rank.index - 0.5 * (rank.count - 1)) * 1.08 * u * p.axis;
  // Through a wheel, in which it would not be seen.
  const double reach = std::max(0.54 * u * rank.count + 0.7 * u, wheel_half(assembly, index) + 0.7 * u);
  sketch.pen.color = colors.metal;
  sketch.tube(knuckle, p.axis, half, 0.98 * u, 0.14 * u);
  sketch.pen.color = colors.metal_dark;
  sketch.disc(p.at, p.axis, reach, 0.5 * u, 0.16 * u);
  if (!on_ground) return;
  const Vec3 side = ground_side(p.axis, assembly.scale.up);
  sketch.pen.color = colors.metal;
  sketch.cylinder(p.at + 0.8 * u * side, p.at + 1.9 * u * side, 0.85 * u, 0.1 * u);
  draw_anchor(sketch, p.at + 2.2 * u * side, -side, 2.2 * u, u, colors);
}

// The bushings that tell a slider from any other body on its rail.
void draw_bushings(Sketch& sketch, const Assembly& assembly, std::size_t index, const Vec3& slider,
                   const Place& p) {
  const double u = p.unit;
  const int body = assembly.joint_bodies[index][static_cast<std::size_t>(slider_end(assembly, index))];
  if (body >= 0 && !assembly.mechanism.bodies[static_cast<std::size_t>(body)].shapes.empty())
    return sketch.tube(slider, p.axis, 1.9 * u, 1.1 * u, 0.1 * u);
  const bool round =
      assembly.mechanism.joints[index].type == JointType::cylindrical || slides_on_shaft(assembly, index);
  for (const double side : {-1.0, 1.0}) {
    if (round)
      sketch.tube(slider + side * 1.25 * u * p.axis, p.axis, 0.22 * u, 1.5 * u, 0.08 * u);
    else
      sketch.box(slider + side * 1.65 * u * p.axis, frame_along(p.axis, assembly.scale.up),
                 {0.9 * u, 0.9 * u, 0.2 * u}, 0.08 * u);
  }
}

void draw_prismatic(Sketch& sketch, const Assembly& assembly, std::size_t index, const Place& p,
                    const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  const double u = p.unit;
  const int end = slider_end(assembly, index);
  const Vec3 slider = end == 1 ? p.there : p.at, rail = end == 1 ? p.at : p.there;
  sketch.pen.color = colors.metal_dark;
  draw_bushings(sketch, assembly, index, slider, p);
  if (assembly.joint_bodies[index][end == 1 ? 0 : 1] >= 0 || joint.coordinates.empty()) return;
  const Coordinate& c = joint.coordinates.back();
  const SlideRange range = slide_range(assembly, index, joint.coordinates.size() - 1);
  const Vec3 axis = (end == 1 ? 1 : -1) * p.axis;
  // A spring's own plate is the end of the rail; elsewhere there is room for what slides.
  const auto end_at = [&](double value, double sense) {
    const bool plate = has_anchor(c) && value == range.anchor;
    const double room = std::max(2.2 * u, (sense < 0 ? range.below : range.above) + 0.6 * u);
    return Vec3(rail + (value - c.drawn + (plate ? 0 : sense * room)) * axis);
  };
  const Vec3 from = end_at(range.from, -1), to = end_at(range.to, 1);
  sketch.pen.color = colors.metal;
  sketch.cylinder(from, to, 0.45 * u, 0.1 * u);
  draw_anchor(sketch, from, axis, 1.7 * u, u, colors);
  draw_anchor(sketch, to, -axis, 1.7 * u, u, colors);
}

void draw_universal(Sketch& sketch, const Place& p, const Palette& colors) {
  const double u = p.unit;
  for (const Vec3& axis : {p.axis, p.axis2}) {
    sketch.pen.color = colors.metal;
    sketch.disc(p.at, axis, 1.5 * u, 0.36 * u, 0.1 * u);
    sketch.pen.color = colors.metal_dark;
    for (const double side : {-1.0, 1.0})
      sketch.disc(p.at + side * 1.35 * u * axis, axis, 0.3 * u, 0.62 * u, 0.1 * u);
  }
  sketch.pen.color = colors.metal;
  sketch.sphere(p.at, 0.62 * u);
}

void draw_spherical(Sketch& sketch, const Assembly& assembly, const Place& p, const Palette& colors) {
  const double u = p.unit;
  Vec3 bottom = -assembly.scale.up;
  if (p.parent >= 0) {
    const Vec3 hub = assembly.poses[static_cast<std::size_t>(p.parent)].position - p.at;
    if (hub.norm() > 0.5 * u) bottom = hub.normalized();
  }
  sketch.pen.color = colors.metal;
  sketch.sphere(p.at, 0.85 * u);
  sketch.pen.color = colors.metal_dark;
  sketch.bowl(p.at, bottom, 1.25 * u);
  if (p.parent < 0) draw_anchor(sketch, p.at + 1.6 * u * bottom, -bottom, 2 * u, u, colors);
}

void draw_distance(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  const auto [first, second] = assembly.joint_bodies[index];
  const double u = assembly.scale.unit;
  const Vec3 a = assembly.point(first, joint.points[0]), b = assembly.point(second, joint.points[1]);
  sketch.pen.role = Role::link;
  sketch.pen.color = colors.metal;
  sketch.rod(a, b, 0.32 * u);
  sketch.pen.color = colors.metal_dark;
  for (const auto& [body, at] : {std::pair(first, a), std::pair(second, b)}) {
    if (!within_ball(assembly, body, at, 0.68 * u)) sketch.sphere(at, 0.68 * u);
    if (body < 0) draw_anchor(sketch, at, -assembly.scale.up, 1.6 * u, u, colors);
  }
}

} // namespace

void draw_anchor(Sketch& sketch, const Vec3& at, const Vec3& normal, double radius, double unit,
                 const Palette& colors) {
  const Pen before = sketch.pen;
  sketch.pen.surface = Surface::hatched;
  sketch.pen.role = Role::anchor;
  sketch.pen.color = colors.metal;
  sketch.disc(at, normal, anchor_half(radius, unit), radius, 0.1 * unit);
  sketch.pen = before;
}

void draw_joint(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  sketch.pen = {colors.metal, Surface::metal, Role::joint, {PartKind::joint, static_cast<int>(index)}};
  if (joint.type == JointType::distance) return draw_distance(sketch, assembly, index, colors);
  if (joint.type == JointType::gear) return draw_gear(sketch, assembly, index, colors);
  const Place p = place_of(assembly, index);
  const double u = p.unit;
  switch (joint.type) {
  case JointType::revolute: return draw_revolute(sketch, assembly, index, p, colors);
  case JointType::prismatic:
  case JointType::cylindrical: return draw_prismatic(sketch, assembly, index, p, colors);
  case JointType::universal: draw_universal(sketch, p, colors); break;
  case JointType::spherical: return draw_spherical(sketch, assembly, p, colors);
  case JointType::planar:
    sketch.box(p.at - 0.3 * u * p.axis, frame_along(p.axis, p.axis2), {5 * u, 5 * u, 0.14 * u}, 0.1 * u);
    sketch.pen.color = colors.metal_dark;
    sketch.disc(p.there, p.axis, 0.25 * u, 1.2 * u, 0.1 * u);
    break;
  case JointType::fixed:
    sketch.pen.color = colors.metal_dark;
    sketch.box(p.at, Quat::Identity(), Vec3::Constant(0.75 * u), 0.12 * u);
    break;
  default: return;
  }
  if (p.parent < 0)
    draw_anchor(sketch, p.at - 1.5 * u * assembly.scale.up, assembly.scale.up, 2 * u, u, colors);
}

void draw_cut_mark(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  if (joint.type == JointType::gear) return;
  const double u = assembly.scale.unit;
  sketch.pen = {colors.cut, Surface::plain, Role::cut_mark, {PartKind::joint, static_cast<int>(index)}};
  if (joint.type != JointType::distance) {
    const Place p = place_of(assembly, index);
    return sketch.ring(p.there, p.axis, 1.9 * u, 0.2 * u, true);
  }
  const auto [first, second] = assembly.joint_bodies[index];
  const Vec3 a = assembly.point(first, joint.points[0]), b = assembly.point(second, joint.points[1]);
  const Vec3 along = (b - a).stableNormalized();
  if (!(along.norm() > 0)) return;
  // The double bar that breaks a line in drawings.
  for (const double side : {-1.0, 1.0})
    sketch.disc(0.5 * (a + b) + side * 0.38 * u * along, along, 0.13 * u, 0.95 * u, 0.08 * u);
}

namespace {

// Of a point of the drawn pose, m.
bool is_inside(const Shape& shape, const Body& body, const Vec3& point) {
  const Vec3 d = point - shape.at.value_or(body.position);
  switch (shape.type) {
  case ShapeType::sphere: return d.norm() < shape.radius;
  case ShapeType::box:
    return ((body.rotation.conjugate() * d).cwiseAbs().array() < 0.5 * shape.size.array()).all();
  default: break;
  }
  const Vec3 line = shape.to - shape.from, from = point - shape.from;
  const double along = from.dot(line), square = line.squaredNorm();
  return along > 0 && along < square &&
         from.squaredNorm() * square - along * along < shape.radius * shape.radius * square;
}

// How far the shape reaches along an axis from a point of it (m), either way.
std::array<double, 2> reach_of(const Shape& shape, const Body& body, const Vec3& origin, const Vec3& axis) {
  const bool line = shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule;
  const Vec3 at = shape.at.value_or(body.position);
  const double from = axis.dot((line ? shape.from : at) - origin),
               to = axis.dot((line ? shape.to : at) - origin);
  double around = shape.radius;
  if (shape.type == ShapeType::box)
    around = 0.5 * (body.rotation.conjugate() * axis).cwiseAbs().dot(shape.size);
  if (shape.type == ShapeType::cylinder)
    around *= axis.cross((shape.to - shape.from).stableNormalized()).norm();
  return {std::min(from, to) - around, std::max(from, to) + around};
}

// Where a ring about a joint's axis is drawn.
struct RingPlace {
  double along = 0;  // m, from the joint
  double radius = 0; // m
};

// Beside the joint, or where that is within a disc of its bodies, round it; within something else, beyond
// that. `axis` is of unit length, in the drawn pose.
RingPlace ring_in_sight(const Assembly& assembly, std::size_t index, const Vec3& axis) {
  const Joint& joint = assembly.mechanism.joints[index];
  const double u = assembly.scale.unit;
  const RingPlace beside{1.9 * u, 2.7 * u};
  const Vec3 across = axis.unitOrthogonal(), other = axis.cross(across);
  const auto hides = [&](const Shape& shape, const Body& body, const RingPlace& ring) {
    constexpr int points = 8, most = 4; // of a ring that is seen
    int inside = 0;
    for (int i = 0; i < points; ++i) {
      const double angle = 2 * std::numbers::pi * i / points;
      inside += is_inside(shape, body,
                          joint.at + ring.along * axis +
                              ring.radius * (std::cos(angle) * across + std::sin(angle) * other));
    }
    return inside > most;
  };
  RingPlace ring = beside;
  bool round = !is_geared(assembly.mechanism, joint.name); // teeth would hide it there
  constexpr int tries = 6;
  for (int i = 0; i < tries; ++i) {
    std::optional<RingPlace> rim;
    double beyond = ring.along;
    for (const int b : assembly.joint_bodies[index]) {
      if (b < 0) continue;
      const Body& body = assembly.mechanism.bodies[static_cast<std::size_t>(b)];
      for (const Shape& shape : body.shapes) {
        const auto [low, high] = reach_of(shape, body, joint.at, axis);
        const bool disc = shape.type == ShapeType::cylinder && high - low < 2 * shape.radius &&
                          axis.cross(shape.from - joint.at).norm() < 0.3 * u &&
                          axis.cross(shape.to - joint.at).norm() < 0.3 * u;
        // Close before a larger disc's face the ring is seen from one side only.
        const double near = 1.6 * u;
        const bool before_face = disc && round && shape.radius > ring.radius && ring.along > low - near &&
                                 ring.along < high + near;
        if (!before_face && !hides(shape, body, ring)) continue;
        beyond = std::max(beyond, high + 0.9 * u);
        if (disc && (!rim || shape.radius > rim->radius)) rim = RingPlace{0.5 * (low + high), shape.radius};
      }
    }
    if (beyond == ring.along && !(rim && round)) break;
    ring =
        rim && round ? RingPlace{rim->along, 1.1 * rim->radius + 0.4 * u} : RingPlace{beyond, beside.radius};
    if (rim) round = false;
  }
  return ring;
}

} // namespace

void draw_drives(Sketch& sketch, const Assembly& assembly, std::size_t index, const Palette& colors) {
  const Joint& joint = assembly.mechanism.joints[index];
  const double u = assembly.scale.unit;
  sketch.pen = {colors.accent, Surface::plain, Role::drive, {PartKind::joint, static_cast<int>(index)}};
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
    if (!joint.coordinates[i].drive) continue;
    const double speed = joint.coordinates[i].drive->speed;
    const Place p = place_of(assembly, index);
    const CoordinateAxis along = coordinate_axis(joint, i);
    const Vec3 axis = assembly.vector(along.end == 0 ? p.parent : p.child, along.axis);
    const Vec3 forward = speed < 0 ? Vec3(-axis) : axis;
    // The head is turned to the front, where it is seen.
    const Vec3 front = Vec3(0.5, 0.3, 0.8) + 0.01 * axis.unitOrthogonal();
    const Vec3 start = forward.cross(front);
    if (!along.angle) {
      const Vec3 beside = p.there + 2.6 * u * axis.unitOrthogonal();
      sketch.arrow(beside - 2.5 * u * forward, beside + 2.5 * u * forward, 0.24 * u);
      continue;
    }
    const RingPlace ring =
        along.end == 0 ? ring_in_sight(assembly, index, along.axis) : RingPlace{1.9 * u, 2.7 * u};
    Vec3 center = p.at + ring.along * axis;
    double radius = ring.radius;
    for (const int body : {p.parent, p.child}) {
      const auto shaft = shaft_of(assembly, body);
      if (!shaft || shaft->joint != static_cast<int>(index)) continue;
      // Round the base of a turntable, otherwise above the bearing.
      const bool broad = is_broad(*shaft, u);
      center =
          shaft->origin + (shaft->from + (broad ? 0.5 * shaft->base_height : 3.4 * u)) * shaft->direction;
      radius = broad ? 1.1 * shaft->base + 0.4 * u : 2.7 * u;
    }
    const double wire = std::max(0.24 * u, 0.02 * radius);
    if (speed == 0)
      sketch.ring(center, axis, radius, wire, false);
    else
      sketch.turn(center, forward, start, radius, wire);
  }
}

} // namespace flyball
