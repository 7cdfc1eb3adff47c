#include "app/viewport/assembly.hpp"

#include "app/viewport/camera.hpp"
#include "engine/mechanism/damped.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace flyball {

namespace {

Vec3 direction(const Vec3& v, const Vec3& otherwise) {
  const double length = v.stableNorm();
  return length > 0 && std::isfinite(length) ? Vec3(v / length) : otherwise;
}

} // namespace

namespace {

Bounds bounds_of(const Shape& shape, const Body& body) {
  const bool line = shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule;
  // A box and the flat ends of a cylinder are taken along the world's axes: near enough for glyphs.
  Vec3 around = Vec3::Constant(shape.radius);
  if (shape.type == ShapeType::box) around = 0.5 * shape.size;
  if (shape.type == ShapeType::cylinder) {
    const Vec3 along = (shape.to - shape.from).stableNormalized();
    around = shape.radius * (Vec3::Ones() - along.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  }
  Bounds bounds;
  for (const Vec3& p : {line ? shape.from : shape.at.value_or(body.position),
                        line ? shape.to : shape.at.value_or(body.position)}) {
    bounds.add(Vec3(p - around));
    bounds.add(Vec3(p + around));
  }
  return bounds;
}

} // namespace

Bounds shape_bounds(const Body& body) {
  Bounds bounds;
  for (const Shape& shape : body.shapes)
    bounds.add(bounds_of(shape, body));
  return bounds;
}

namespace {

SceneScale scale_of(const Assembly& assembly) {
  SceneScale scale;
  scale.up = up_axis(assembly.mechanism);
  std::vector<double> lengths;
  bool all_shaped = true;
  for (std::size_t i = 0; i < assembly.mechanism.bodies.size(); ++i) {
    const Body& body = assembly.mechanism.bodies[i];
    Bounds reach;
    reach.add(body.position);
    for (const Attachment& a : assembly.attachments[i])
      reach.add(a.at);
    // A mass centre a little beside the only joint says nothing of how long it is: its shapes do.
    constexpr double little = 0.1;
    const Bounds shapes = shape_bounds(body);
    const double held = reach.radius(), shaped = shapes.empty ? 0 : shapes.radius();
    if (const double length = 2 * (held > 0 && held < little * shaped ? shaped : held); length > 0)
      lengths.push_back(length);
    scale.bounds.add(reach);
    scale.bounds.add(shapes);
    all_shaped = all_shaped && !body.shapes.empty();
  }
  for (const Joint& joint : assembly.mechanism.joints) {
    if (joint.type == JointType::gear) continue;
    if (joint.type != JointType::distance) {
      scale.bounds.add(joint.at);
      continue;
    }
    for (const Vec3& p : joint.points)
      scale.bounds.add(p);
    if (const double length = (joint.points[0] - joint.points[1]).stableNorm(); length > 0)
      lengths.push_back(length);
  }
  std::vector<double> springs;
  for (const Force& force : assembly.mechanism.forces) {
    if (force.type != ForceType::spring) continue;
    for (const Vec3& p : force.points)
      scale.bounds.add(p);
    if (const double length = (force.points[0] - force.points[1]).stableNorm(); length > 0)
      springs.push_back(length);
  }
  // Where springs are most of what there is, as in a net of them, the glyphs fit into its meshes.
  constexpr std::size_t several = 8;
  if (springs.size() >= several && springs.size() > lengths.size()) lengths = std::move(springs);

  const double size = 2 * scale.bounds.radius();
  if (!(size > 0) || !std::isfinite(size)) {
    scale.unit = 0.05;
    return scale;
  }
  scale.unit = 0.035 * size;
  if (!lengths.empty()) {
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    scale.unit = std::clamp(0.1 * *middle, 1e-6 * size, scale.unit);
  }
  if (all_shaped) scale.unit *= 0.75; // whoever gave the shapes wants to see them
  return scale;
}

double median_mass(const Mechanism& mechanism) {
  std::vector<double> masses;
  masses.reserve(mechanism.bodies.size());
  for (const Body& body : mechanism.bodies)
    if (body.mass > 0) masses.push_back(body.mass);
  if (masses.empty()) return 0;
  const auto middle = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  return *middle;
}

} // namespace

CoordinateAxis coordinate_axis(const Joint& joint, std::size_t coordinate) {
  const int i = static_cast<int>(coordinate);
  const Vec3 axis = direction(joint.axis, Vec3::UnitZ());
  CoordinateAxis result{axis, 0, i < coordinate_count(joint.type) && is_angle(joint.type, i)};
  switch (joint.type) {
  case JointType::universal:
    if (i == 1) result = {direction(joint.axis2, Vec3::UnitX()), 1, true};
    break;
  case JointType::planar: {
    const Vec3 x = direction(joint.axis2 - axis * axis.dot(joint.axis2), axis.unitOrthogonal());
    if (i == 0) result.axis = x;
    if (i == 1) result.axis = axis.cross(x);
    break;
  }
  case JointType::spherical:
  case JointType::free: result.axis = Vec3::Unit(i % 3); break;
  default: break;
  }
  return result;
}

double coordinate_value(const Assembly& assembly, std::size_t index, std::size_t coordinate) {
  const Joint& joint = assembly.mechanism.joints[index];
  const auto [parent, child] = assembly.joint_bodies[index];
  const CoordinateAxis along = coordinate_axis(joint, coordinate);
  const Vec3 axis = assembly.vector(along.end == 0 ? parent : child, along.axis);
  const double drawn = joint.coordinates[coordinate].drawn;
  if (!along.angle)
    return drawn + axis.dot(assembly.point(child, joint.at) - assembly.point(parent, joint.at));
  const Vec3 across = along.axis.unitOrthogonal();
  const Vec3 from = assembly.vector(parent, across), to = assembly.vector(child, across);
  return drawn + std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

bool has_anchor(const Coordinate& c) {
  return c.spring || is_damped(c);
}

namespace {

// How far the shapes of what slides extend from its point along the slide, back and forth.
std::array<double, 2> slider_reach(const Assembly& assembly, std::size_t index, const Vec3& axis) {
  const auto [parent, child] = assembly.joint_bodies[index];
  const int slider = child >= 0 ? child : parent;
  if (slider < 0) return {0, 0};
  const Body& body = assembly.mechanism.bodies[static_cast<std::size_t>(slider)];
  if (body.shapes.empty()) return {0, 0};
  const Bounds bounds = shape_bounds(body);
  const double sense = slider == child ? 1 : -1; // the other way round where the joint's child is ground
  const double middle = sense * axis.dot(bounds.center() - assembly.mechanism.joints[index].at);
  const double half = axis.cwiseAbs().dot(0.5 * (bounds.upper - bounds.lower));
  return {std::max(half - middle, 0.0), std::max(half + middle, 0.0)};
}

// How far it is from a slide's point in a direction to the shapes of what it slides on; none where it meets
// none of them, or begins inside one.
std::optional<double> distance_to_rail(const Assembly& assembly, std::size_t index, const Vec3& direction) {
  const auto [parent, child] = assembly.joint_bodies[index];
  const int rail = child >= 0 ? parent : -1;
  if (rail < 0) return std::nullopt;
  const Vec3& at = assembly.mechanism.joints[index].at;
  const Body& body = assembly.mechanism.bodies[static_cast<std::size_t>(rail)];
  std::optional<double> nearest;
  for (const Shape& shape : body.shapes) {
    const Bounds bounds = bounds_of(shape, body);
    double enters = -std::numeric_limits<double>::infinity(), leaves = -enters;
    for (int k = 0; k < 3; ++k) {
      const double low = bounds.lower[k] - at[k], high = bounds.upper[k] - at[k];
      if (std::abs(direction[k]) < 1e-9) {
        if (low > 0 || high < 0) leaves = -std::numeric_limits<double>::infinity();
        continue;
      }
      enters = std::max(enters, std::min(low / direction[k], high / direction[k]));
      leaves = std::min(leaves, std::max(low / direction[k], high / direction[k]));
    }
    if (!(enters <= leaves) || leaves < 0) continue;
    if (enters < 0) return std::nullopt;
    nearest = std::min(nearest.value_or(enters), enters);
  }
  return nearest;
}

// How far a spring's other end is at least from the slide's point, on this side of it (1: below).
double room_for_spring(const SlideRange& range, int side, double unit) {
  return std::max((side > 0 ? range.below : range.above) + 1.5 * unit, 3 * unit);
}

// Puts the spring's other end on what the slide is on, where that is below or above all that the coordinate
// takes. Returns on which side (1: below), 0 where it is on none.
int stand_on_rail(const Assembly& assembly, std::size_t index, const Vec3& axis, double drawn,
                  SlideRange& range) {
  constexpr double farthest = 8; // times the room that it takes
  for (const int side : {1, -1}) {
    const std::optional<double> rail = distance_to_rail(assembly, index, -side * axis);
    const double room = room_for_spring(range, side, assembly.scale.unit);
    if (!rail || *rail > farthest * room) continue;
    const double anchor = drawn - side * *rail, nearest = side > 0 ? range.from : range.to;
    if (side * (nearest - anchor) < room) continue;
    range.anchor = anchor;
    return side;
  }
  return 0;
}

} // namespace

SlideRange slide_range(const Assembly& assembly, std::size_t index, std::size_t coordinate) {
  const Joint& joint = assembly.mechanism.joints[index];
  const Coordinate& c = joint.coordinates[coordinate];
  const double unit = assembly.scale.unit, travel = assembly.crank_travel[index];
  const Vec3 axis = coordinate_axis(joint, coordinate).axis;
  const auto [below, above] = slider_reach(assembly, index, axis);
  SlideRange range{c.drawn, c.drawn, c.drawn, below, above};
  const auto include = [&](double value) {
    range.from = std::min(range.from, value);
    range.to = std::max(range.to, value);
  };
  const double free = c.spring ? c.spring->free : c.drawn;
  include(free);
  include(c.drawn - travel);
  include(c.drawn + travel);
  // A spring as long as its coordinate starts at zero; otherwise the label says nothing about its length.
  const int side = c.drawn < 0 ? -1 : 1; // of zero, where the coordinate is
  const bool never_crosses = side * (side > 0 ? range.from : range.to) > 2 * unit &&
                             (!c.stop || !(side > 0 ? c.stop->lower : c.stop->upper) ||
                              side * *(side > 0 ? c.stop->lower : c.stop->upper) >= 0);
  const bool from_zero = c.spring && never_crosses;
  // The spring stands by what was foreseen, not by the poses, nor by stops, which may be far beyond; but on
  // no shapes up to which they let it come.
  const double lowest = range.from, now = coordinate_value(assembly, index, coordinate);
  if (c.stop && c.stop->lower) include(*c.stop->lower);
  if (c.stop && c.stop->upper) include(*c.stop->upper);
  const int on_rail = has_anchor(c) && !from_zero ? stand_on_rail(assembly, index, axis, c.drawn, range) : 0;
  if (std::isfinite(now)) include(now);
  if (has_anchor(c)) {
    const double length =
        std::max({6 * unit, room_for_spring(range, 1, unit), 1.6 * std::abs(c.drawn - free)});
    if (on_rail == 0) range.anchor = from_zero ? 0 : lowest - length;
    const int towards = from_zero ? side : on_rail != 0 ? on_rail : 1;
    // One that starts at zero may be pressed flat.
    const double least = from_zero ? 2 * unit : room_for_spring(range, towards, unit);
    if (towards * (now - range.anchor) < least) range.anchor = now - towards * least;
    include(range.anchor);
  }
  if (range.to - range.from < unit) {
    include(c.drawn - 5 * unit);
    include(c.drawn + 5 * unit);
  }
  return range;
}

namespace {

struct Span {
  double low, high;
};

Span along(const Shaft& shaft, const Bounds& bounds) {
  const double middle = shaft.direction.dot(bounds.center() - shaft.origin);
  const double half = shaft.direction.cwiseAbs().dot(0.5 * (bounds.upper - bounds.lower));
  return {middle - half, middle + half};
}

// How far a shape reaches from its middle across a direction, all round: of what lies across it like a rod on
// a pivot, how thick that is.
double girth(const Shape& shape, const Vec3& half, const Vec3& direction) {
  const bool line = shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule;
  const Vec3 along = (shape.to - shape.from).stableNormalized();
  if (line && along.cross(direction).norm() > 0.1) return shape.radius;
  const Vec3 across = (half - direction * direction.dot(half)).cwiseAbs();
  if (shape.type != ShapeType::box) return across.maxCoeff();
  std::array<double, 3> sides{across[0], across[1], across[2]}; // one of them along the direction
  std::ranges::sort(sides);
  return sides[1];
}

// Ends the shaft where its shapes end. One whose bearing is at its upper end, with what it carries below,
// hangs.
void fit_to_shapes(Shaft& shaft, const Body& body, std::span<const Attachment> attachments, double unit) {
  const Span whole = along(shaft, shape_bounds(body));
  bool hangs = whole.high < -whole.low;
  for (const Attachment& a : attachments)
    if (a.joint != shaft.joint && (a.at - shaft.origin).norm() < 2 * unit) hangs = false;
  shaft.from = whole.low;
  shaft.to = whole.high;
  if (hangs) {
    shaft.direction = -shaft.direction;
    shaft.from = -whole.high;
    shaft.to = -whole.low;
  }
  for (const Shape& shape : body.shapes) {
    const Bounds bounds = bounds_of(shape, body);
    const Span span = along(shaft, bounds);
    const Vec3 half = 0.5 * (bounds.upper - bounds.lower);
    const double radius = girth(shape, half, shaft.direction);
    if (span.low > shaft.from + 0.5 * unit || radius <= shaft.base) continue;
    shaft.base = radius;
    shaft.base_height = span.high - span.low;
  }
}

} // namespace

bool is_broad(const Shaft& shaft, double unit) {
  return shaft.base > 1.8 * unit;
}

bool on_axis(const Shaft& shaft, const Vec3& drawn, double unit) {
  return (drawn - shaft.origin).cross(shaft.direction).norm() < 0.6 * unit;
}

bool is_geared(const Mechanism& mechanism, const std::string& joint) {
  return std::ranges::any_of(mechanism.joints, [&](const Joint& gear) {
    return gear.type == JointType::gear && std::ranges::any_of(gear.joints, [&](const std::string& end) {
             return end.substr(0, end.find('.')) == joint;
           });
  });
}

namespace {

std::optional<Shaft> find_shaft(const Assembly& assembly, std::size_t b) {
  const std::vector<Attachment>& attachments = assembly.attachments[b];
  const double unit = assembly.scale.unit;
  for (const Attachment& bearing : attachments) {
    if (bearing.joint < 0) continue;
    const Joint& joint = assembly.joint(bearing.joint);
    // A wheel alone is one if it is driven, so that the drive's sign is round it rather than within it; one
    // with teeth, which would hide that, has it before them.
    const bool alone = attachments.size() < 2;
    if (alone && (joint.coordinates.empty() || !joint.coordinates[0].drive ||
                  is_geared(assembly.mechanism, joint.name)))
      continue;
    const auto j = static_cast<std::size_t>(bearing.joint);
    const bool on_ground = assembly.joint_bodies[j][0] < 0 || assembly.joint_bodies[j][1] < 0;
    if (!on_ground || (joint.type != JointType::revolute && joint.type != JointType::cylindrical)) continue;

    Shaft shaft;
    shaft.origin = joint.at;
    shaft.direction = direction(joint.axis, Vec3::UnitZ());
    shaft.joint = bearing.joint;
    if (shaft.direction.dot(assembly.scale.up) < 0) shaft.direction = -shaft.direction;
    const auto include = [&](const Vec3& p) {
      const double along = shaft.direction.dot(p - shaft.origin);
      shaft.from = std::min(shaft.from, along);
      shaft.to = std::max(shaft.to, along);
    };
    const Body& turning = assembly.mechanism.bodies[b];
    const auto off_axis = [&](const Vec3& p) { return !on_axis(shaft, p, unit); };
    if (off_axis(turning.position)) continue;
    // With shapes of its own it may carry things anywhere, as a turntable does.
    if (turning.shapes.empty() && std::any_of(attachments.begin(), attachments.end(),
                                              [&](const Attachment& a) { return off_axis(a.at); }))
      continue;
    include(assembly.mechanism.bodies[b].position);
    for (const Attachment& a : attachments) {
      include(a.at);
      if (a.joint < 0) continue;
      const Joint& other = assembly.joint(a.joint);
      if (other.type != JointType::prismatic && other.type != JointType::cylindrical) continue;
      const std::size_t slide = other.type == JointType::cylindrical ? 1 : 0;
      const Vec3 axis = direction(other.axis, Vec3::UnitZ());
      if (slide >= other.coordinates.size() || axis.cross(shaft.direction).norm() > 1e-3) continue;
      const double drawn = other.coordinates[slide].drawn;
      const SlideRange range = slide_range(assembly, static_cast<std::size_t>(a.joint), slide);
      for (const double value : {range.from, range.to})
        include(other.at + (a.end == 0 ? 1 : -1) * (value - drawn) * axis);
    }
    if (!turning.shapes.empty()) {
      fit_to_shapes(shaft, turning, attachments, unit);
      if (alone && !is_broad(shaft, unit)) continue;
      return shaft;
    }
    if (alone) continue;
    shaft.from -= 7 * unit;
    shaft.to += 2.2 * unit;
    return shaft;
  }
  return std::nullopt;
}

bool on_shaft(const Assembly& assembly, const Joint& joint, int body) {
  const std::optional<Shaft> shaft = shaft_of(assembly, body);
  return shaft && on_axis(*shaft, joint.at, assembly.scale.unit) &&
         direction(joint.axis, Vec3::UnitZ()).cross(shaft->direction).norm() < 1e-3;
}

// A joint that turns on and on, driven or by a gear.
std::vector<std::size_t> turning_joints(const Mechanism& mechanism) {
  std::vector<std::size_t> turning;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (joint.type == JointType::gear) {
      for (const std::string& name : joint.joints)
        if (const auto [geared, i] = find_coordinate(mechanism, name);
            geared >= 0 &&
            coordinate_axis(mechanism.joints[static_cast<std::size_t>(geared)], static_cast<std::size_t>(i))
                .angle)
          turning.push_back(static_cast<std::size_t>(geared));
      continue;
    }
    const bool turns = joint.type == JointType::revolute || joint.type == JointType::cylindrical;
    if (turns && !joint.coordinates.empty() && joint.coordinates[0].drive &&
        joint.coordinates[0].drive->speed != 0)
      turning.push_back(j);
  }
  return turning;
}

// Whether joints lead from one body to another (-1: ground) without passing `base`.
bool connected(const Assembly& assembly, int from, int to, int base) {
  const auto place = [](int body) { return static_cast<std::size_t>(body + 1); };
  std::vector<std::vector<int>> beside(assembly.mechanism.bodies.size() + 1);
  for (std::size_t j = 0; j < assembly.mechanism.joints.size(); ++j) {
    const auto [a, b] = assembly.joint_bodies[j];
    if (assembly.mechanism.joints[j].type == JointType::gear || a == base || b == base) continue;
    beside[place(a)].push_back(b);
    beside[place(b)].push_back(a);
  }
  std::vector<char> reached(beside.size(), 0);
  std::vector<int> next{from};
  reached[place(from)] = 1;
  while (!next.empty()) {
    const int body = next.back();
    next.pop_back();
    if (body == to) return true;
    for (const int b : beside[place(body)])
      if (!reached[place(b)]) {
        reached[place(b)] = 1;
        next.push_back(b);
      }
  }
  return false;
}

// A crank that turns in one of the slide's bodies and drives the other through rods moves it by twice its
// radius, and a little more where their lines miss each other.
double travel_by_cranks(const Assembly& assembly, std::size_t slide, std::span<const std::size_t> turning) {
  const Joint& sliding = assembly.mechanism.joints[slide];
  double travel = 0;
  for (const std::size_t t : turning) {
    const Joint& joint = assembly.mechanism.joints[t];
    const Vec3 axis = direction(joint.axis, Vec3::UnitZ());
    const double across = axis.cross(direction(sliding.axis, Vec3::UnitZ())).norm();
    for (const int base : assembly.joint_bodies[slide])
      for (const std::size_t end : {0u, 1u}) {
        const int crank = assembly.joint_bodies[t][1 - end];
        const auto [parent, child] = assembly.joint_bodies[slide];
        const int pushed = base == parent ? child : parent;
        if (assembly.joint_bodies[t][end] != base || crank < 0 || !(across > 1e-3)) continue;
        double radius = 0;
        for (const Attachment& a : assembly.attachments[static_cast<std::size_t>(crank)])
          radius = std::max(radius, (a.at - joint.at).cross(axis).norm());
        if (2.2 * radius * across > travel && connected(assembly, crank, pushed, base))
          travel = 2.2 * radius * across;
      }
  }
  return travel;
}

} // namespace

Assembly::Assembly(const Mechanism& built, std::span<const Pose> in_poses)
    : mechanism(built), poses(in_poses), attachments(built.bodies.size()) {
  std::unordered_map<std::string_view, int> index;
  for (std::size_t i = 0; i < built.bodies.size(); ++i)
    index.emplace(built.bodies[i].name, static_cast<int>(i));
  const auto find = [&](std::string_view name) {
    const auto found = index.find(name);
    return found == index.end() ? -1 : found->second;
  };
  const auto attach = [&](int body, const Attachment& a) {
    if (body >= 0 && a.at.allFinite()) attachments[static_cast<std::size_t>(body)].push_back(a);
  };
  joint_bodies.reserve(built.joints.size());
  for (std::size_t i = 0; i < built.joints.size(); ++i) {
    const Joint& joint = built.joints[i];
    joint_bodies.push_back({find(joint.bodies[0]), find(joint.bodies[1])});
    if (joint.type == JointType::gear || joint.type == JointType::free) continue;
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      attach(joint_bodies.back()[e],
             {joint.type == JointType::distance ? joint.points[e] : joint.at, static_cast<int>(i), end});
    }
  }
  for (const Force& force : built.forces) {
    const bool two = acts_between(force.type);
    force_bodies.push_back({find(two ? force.bodies[0] : force.body), two ? find(force.bodies[1]) : -1});
    if (force.type == ForceType::spring)
      for (std::size_t e = 0; e < 2; ++e)
        attach(force_bodies.back()[e], {force.points[e], -1, static_cast<int>(e)});
  }
  scale = scale_of(*this);
  middle_mass = median_mass(built);
  for (const Force& force : built.forces) {
    double& largest = largest_vectors[static_cast<std::size_t>(force.type)];
    largest = std::max(largest, force.vector.stableNorm());
  }
  crank_travel.assign(built.joints.size(), 0);
  if (const std::vector<std::size_t> turning = turning_joints(built); !turning.empty())
    for (std::size_t j = 0; j < built.joints.size(); ++j)
      if (built.joints[j].type == JointType::prismatic || built.joints[j].type == JointType::cylindrical)
        crank_travel[j] = travel_by_cranks(*this, j, turning);
  for (std::size_t i = 0; i < built.bodies.size(); ++i)
    shafts.push_back(find_shaft(*this, i));
  wheels = toothed_wheels(*this);
}

bool within_ball(const Assembly& assembly, int body, const Vec3& at, double radius) {
  if (body < 0 || assembly.balls.empty()) return false;
  const auto i = static_cast<std::size_t>(body);
  return (at - assembly.poses[i].position).norm() + radius < assembly.balls[i];
}

std::optional<Shaft> shaft_of(const Assembly& assembly, int body) {
  return body < 0 ? std::nullopt : assembly.shafts[static_cast<std::size_t>(body)];
}

int slider_end(const Assembly& assembly, std::size_t joint) {
  const auto [parent, child] = assembly.joint_bodies[joint];
  return child < 0 || on_shaft(assembly, assembly.mechanism.joints[joint], child) ? 0 : 1;
}

bool slides_on_shaft(const Assembly& assembly, std::size_t joint) {
  const auto [parent, child] = assembly.joint_bodies[joint];
  const Joint& j = assembly.mechanism.joints[joint];
  return on_shaft(assembly, j, parent) || on_shaft(assembly, j, child);
}

} // namespace flyball
