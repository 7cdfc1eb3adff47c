// Mechanisms of as many bodies as wanted, without shapes unless said otherwise; their sizes do not depend on
// the count.
#pragma once

#include "tests/app/viewport_mechanisms.hpp"

namespace flyball::test {

// Links of 0.1 m along x, one hinge each, alternately about z and y, the first one driven; a spring and a
// damper in every tenth.
inline Mechanism long_chain(int links) {
  constexpr double length = 0.1;
  Mechanism m;
  m.name = "Chain";
  m.gravity = {0, -9.80665, 0};
  for (int i = 0; i < links; ++i) {
    m.bodies.push_back(body("link" + std::to_string(i), 1, {length * (i + 0.5), 0, 0}));
    Joint joint =
        revolute("hinge" + std::to_string(i), i ? "link" + std::to_string(i - 1) : "ground",
                 "link" + std::to_string(i), {length * i, 0, 0}, i % 2 ? Vec3::UnitZ() : Vec3::UnitY());
    if (i == 0) joint.coordinates[0].drive = Drive{5};
    if (i % 10 == 1) joint.coordinates[0].spring = CoordinateSpring{10, 0};
    if (i % 10 == 1) joint.coordinates[0].damping = 0.1;
    m.joints.push_back(joint);
  }
  return m;
}

// Links of 1 m / `links` hanging from a driven hub, hinges about z, a weak spring in each: stable at low
// speed.
inline Mechanism hanging_chain(int links) {
  const double length = 1. / links;
  Mechanism m;
  m.name = "Hanging chain";
  m.gravity = {0, -9.80665, 0};
  m.bodies.push_back(body("hub", 1, {0, 0, 0}));
  m.joints.push_back(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}));
  m.joints[0].coordinates[0].drive = Drive{2};
  for (int i = 0; i < links; ++i) {
    const Vec3 from(0.1, -length * i, 0);
    m.bodies.push_back(body("link" + std::to_string(i), length, from - Vec3(0, length / 2, 0)));
    Joint joint = revolute("hinge" + std::to_string(i), i ? "link" + std::to_string(i - 1) : "hub",
                           "link" + std::to_string(i), from, Vec3::UnitZ());
    joint.coordinates[0].spring = CoordinateSpring{0.01, 0};
    m.joints.push_back(joint);
  }
  return m;
}

// Every limb carries two shorter ones.
inline Mechanism branching_tree(int limbs) {
  Mechanism m;
  m.name = "Tree";
  m.gravity = {0, -9.80665, 0};
  std::vector<Vec3> ends, directions;
  std::vector<double> lengths;
  for (int i = 0; i < limbs; ++i) {
    const auto carrier = static_cast<std::size_t>(std::max(i - 1, 0) / 2);
    const Vec3 from = i ? ends[carrier] : Vec3(0, 0, 0);
    const Vec3 before = i ? directions[carrier] : Vec3(0, -1, 0);
    const double length = i ? 0.82 * lengths[carrier] : 1, side = i % 2 ? 0.55 : -0.55;
    // Alternately to both sides and to front and back, level by level.
    const int level = static_cast<int>(std::log2(i + 1));
    const Vec3 aside = level % 2 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 along = i ? Vec3((before + side * aside).normalized()) : before;
    directions.push_back(along);
    lengths.push_back(length);
    ends.push_back(from + length * along);
    m.bodies.push_back(body("limb" + std::to_string(i), length, from + 0.5 * length * along));
    m.joints.push_back(revolute("fork" + std::to_string(i), i ? "limb" + std::to_string(carrier) : "ground",
                                "limb" + std::to_string(i), from,
                                i ? along.cross(aside).normalized() : Vec3(0, 1, 0)));
  }
  m.joints[0].coordinates[0].drive = Drive{2};
  return m;
}

// Of the nets below: `side` x `side` knots in the plane of x and z, 0.1 m apart.
inline std::string knot_name(int i, int k) {
  return "n" + std::to_string(i) + "_" + std::to_string(k);
}
inline Vec3 knot_at(int side, int i, int k) {
  return 0.1 * Vec3(i - side / 2, 0, k - side / 2);
}

// `side` x `side` balls in the plane of x and z, 0.1 m apart, joined to their neighbours by links, hung from
// a spindle at their middle.
inline Mechanism cable_net(int side) {
  Mechanism m;
  m.name = "Net";
  m.gravity = {0, -9.80665, 0};
  const auto name = knot_name;
  const auto at = [&](int i, int k) { return knot_at(side, i, k); };
  m.bodies.push_back(body("spindle", 1, {0, 0.2, 0}));
  m.joints.push_back(revolute("spin", "ground", "spindle", {0, 0.3, 0}, {0, 1, 0}));
  m.joints[0].coordinates[0].drive = Drive{5};
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k)
      m.bodies.push_back(body(name(i, k), 1, at(i, k)));
  m.joints.push_back(joint(JointType::spherical, "hold", "spindle", name(side / 2, side / 2),
                           at(side / 2, side / 2), Vec3::Zero()));
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      if (i + 1 < side)
        m.joints.push_back(distance("x" + name(i, k), name(i, k), name(i + 1, k), at(i, k), at(i + 1, k)));
      if (k + 1 < side)
        m.joints.push_back(distance("z" + name(i, k), name(i, k), name(i, k + 1), at(i, k), at(i, k + 1)));
    }
  return m;
}

// `side` x `side` knots in the plane of x and z, 0.1 m apart, tied to their neighbours and at two edges to
// the ground by springs.
inline Mechanism spring_net(int side) {
  Mechanism m;
  m.name = "Net of springs";
  m.gravity = {0, -9.80665, 0};
  const auto name = knot_name;
  const auto at = [&](int i, int k) { return knot_at(side, i, k); };
  const auto tie = [&](const std::string& first, int i, int k, int j, int l) {
    m.forces.push_back(
        point_spring("s" + std::to_string(m.forces.size()), first, name(j, l), at(i, k), at(j, l), 100));
  };
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      m.bodies.push_back(body(name(i, k), 0.01, at(i, k)));
      tie(i ? name(i - 1, k) : "ground", i - 1, k, i, k);
      tie(k ? name(i, k - 1) : "ground", i, k - 1, i, k);
    }
  return m;
}

// Balls of given radius in the plane of x and y, `columns` a row, 0.1 m apart; each held by the ground.
inline Mechanism ball_grid(int columns, int rows, double radius) {
  Mechanism m;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      Body ball = body("ball" + std::to_string(r * columns + c), 1, {0.1 * c, 0.1 * r, 0});
      Shape shape;
      shape.type = ShapeType::sphere;
      shape.radius = radius;
      ball.shapes = {shape};
      m.bodies.push_back(ball);
      m.joints.push_back(joint(JointType::spherical, "pin" + std::to_string(r * columns + c), "ground",
                               ball.name, ball.position, Vec3::Zero()));
    }
  return m;
}

} // namespace flyball::test
