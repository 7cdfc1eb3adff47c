#include "tests/engine/mechanism_random.hpp"

#include <bit>
#include <cmath>

namespace flyball::test {

double RandomMechanism::number() {
  switch (below(6)) {
  case 0: return 0;
  case 1: return below(2001) - 1000;
  case 2: return below(2001) / 1000.0;
  case 3: return std::normal_distribution<double>()(engine_);
  default:
    // Any bits at all: denormals, negative zero, the largest.
    for (;;) {
      const auto high = static_cast<std::uint64_t>(engine_());
      const double any = std::bit_cast<double>(high << 32U | engine_());
      if (std::isfinite(any)) return any;
    }
  }
}

std::string RandomMechanism::text() {
  static const std::vector<std::string> pieces{"a",    "Z", " ",  "9", "\"", "\\", "\n",
                                               "\x01", "ü", "球", "🜚", "/",  "[0]"};
  std::string all;
  for (int i = below(8) + 1; i > 0; --i)
    all += pieces[static_cast<std::size_t>(below(static_cast<int>(pieces.size())))];
  return all;
}

Shape RandomMechanism::shape() {
  Shape shape;
  shape.type = static_cast<ShapeType>(below(4));
  shape.description = description();
  if (shape.type == ShapeType::box)
    shape.size = vector();
  else
    shape.radius = number();
  if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule) {
    shape.from = vector();
    shape.to = vector();
  } else if (maybe()) {
    shape.at = vector();
  }
  if (maybe()) shape.color = {number(), number(), number()};
  return shape;
}

Body RandomMechanism::body() {
  Body body;
  body.name = text();
  body.description = description();
  body.mass = number();
  body.position = vector();
  const int entries = 3 * below(3);
  for (int i = 0; i < entries; ++i)
    body.inertia[static_cast<std::size_t>(i)] = number();
  if (maybe()) body.rotation = Quat(number(), number(), number(), number());
  for (int i = below(3); i > 0; --i)
    body.shapes.push_back(shape());
  return body;
}

Coordinate RandomMechanism::coordinate() {
  Coordinate coordinate;
  if (maybe()) coordinate.drawn = number();
  if (maybe()) coordinate.spring = CoordinateSpring{number(), number(), description()};
  if (maybe()) coordinate.damping = number();
  if (maybe()) coordinate.drive = Drive{number(), description()};
  if (maybe()) {
    Stop stop;
    stop.lower = number();
    if (maybe()) stop.upper = number();
    if (stop.upper && maybe()) stop.lower.reset();
    stop.stiffness = number();
    stop.description = description();
    coordinate.stop = stop;
  }
  return coordinate;
}

Joint RandomMechanism::joint() {
  Joint joint;
  joint.name = text();
  joint.description = description();
  joint.type = static_cast<JointType>(below(10));
  if (joint.type == JointType::gear) {
    joint.joints = {text(), text()};
    joint.kind = static_cast<GearKind>(below(4));
    switch (joint.kind) {
    case GearKind::gear: joint.ratio = number(); break;
    case GearKind::belt:
      joint.radii = {number(), number()};
      joint.crossed = maybe();
      break;
    case GearKind::rack: joint.radii[0] = number(); break;
    case GearKind::screw: joint.lead = number(); break;
    }
    if (maybe()) joint.offset = number();
  } else {
    joint.bodies = {text(), text()};
  }
  if (joint.type == JointType::distance) {
    joint.points = {vector(), vector()};
    if (maybe()) joint.length = number();
  }
  if (has_at(joint.type)) joint.at = vector();
  if (has_axis(joint.type)) joint.axis = vector();
  if (has_axis2(joint.type)) joint.axis2 = vector();
  for (int i = coordinate_count(joint.type); i > 0; --i)
    joint.coordinates.push_back(maybe() ? coordinate() : Coordinate());
  if (maybe()) joint.cut = maybe();
  return joint;
}

Force RandomMechanism::force() {
  Force force;
  force.name = text();
  force.description = description();
  force.type = static_cast<ForceType>(below(6));
  if (force.type == ForceType::spring) {
    force.bodies = {text(), text()};
    force.points = {vector(), vector()};
    if (maybe())
      force.force = number();
    else
      force.stiffness = number();
    if (maybe()) force.free_length = number();
    force.damping = number();
    return force;
  }
  if (force.type == ForceType::bearing) {
    force.bodies = {text(), text()};
    force.at = vector();
    force.axis = vector();
    if (maybe()) force.x_axis = vector();
    const int entries = maybe() ? 4 : 36;
    for (int i = 0; i < entries; ++i)
      force.bearing_stiffness.push_back(number());
    if (maybe()) force.bearing_damping = force.bearing_stiffness;
    return force;
  }
  force.body = text();
  if (maybe()) force.at = vector();
  if (force.type == ForceType::drag) {
    force.linear = number();
    force.quadratic = number();
  } else if (force.type == ForceType::vane) {
    force.area = number();
    force.normal = vector();
    if (maybe()) force.chord = vector();
    if (maybe()) {
      force.lift = number();
      if (maybe()) force.drag = number();
      return force;
    }
    force.cn = number();
    force.cd = number();
  } else {
    force.vector = vector();
    force.frame = static_cast<ForceFrame>(below(2));
  }
  return force;
}

Mechanism RandomMechanism::operator()() {
  Mechanism m;
  m.name = text();
  m.description = description();
  if (maybe()) m.gravity = vector();
  if (maybe()) m.air = {number(), vector(), maybe() ? text() : "", description()};
  for (int i = below(4); i > 0; --i)
    m.bodies.push_back(body());
  for (int i = below(6); i > 0; --i)
    m.joints.push_back(joint());
  for (int i = below(4); i > 0; --i)
    m.forces.push_back(force());
  for (int i = below(3); i > 0; --i)
    m.sliders.push_back({text(), number(), number(), static_cast<SliderScale>(below(2)), description()});
  if (maybe()) m.simulation = {number(), maybe(), description()};
  if (maybe()) m.view.camera = Camera{vector(), number(), number(), number(), description()};
  if (maybe()) m.view.description = text();
  return m;
}

} // namespace flyball::test
