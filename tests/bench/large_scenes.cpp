#include "tests/bench/large_scenes.hpp"

#include "tests/support/parts.hpp"

#include <cmath>

namespace flyball::bench {

using test::revolute;
using test::rod;

namespace {

constexpr double gravity = 9.80665;

Mechanism on_a_hub(const std::string& name, double speed) {
  Mechanism m;
  m.name = name;
  m.gravity = {0, -gravity, 0};
  m.bodies = {test::body("hub")};
  m.joints = {test::driven(test::revolute("spin", "ground", "hub", {0, 0, 0}, Vec3::UnitY()), speed)};
  return m;
}

} // namespace

Mechanism chain(int links, double speed, double tilt, double length, double mass) {
  Mechanism m = on_a_hub("Chain of " + std::to_string(links), speed);
  const Vec3 way = length / links * Vec3(std::sin(tilt), -std::cos(tilt), 0);
  for (int i = 0; i < links; ++i) {
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(rod(name, mass / links, i * way, (i + 1) * way));
    m.joints.push_back(revolute("hinge" + std::to_string(i), m.bodies[static_cast<std::size_t>(i)].name, name,
                                i * way, Vec3::UnitZ()));
  }
  return m;
}

Mechanism springy_chain(int links, double speed, double stiffness, double damping) {
  Mechanism m = chain(links, speed);
  for (std::size_t i = 1; i < m.joints.size(); ++i) {
    m.joints[i].coordinates[0].spring = CoordinateSpring{stiffness, 0};
    m.joints[i].coordinates[0].damping = damping;
  }
  return m;
}

Mechanism binary_tree(int rods, double speed) {
  Mechanism m = on_a_hub("Tree of " + std::to_string(rods), speed);
  std::vector<Vec3> tip{Vec3::Zero()};
  for (int i = 0; i < rods; ++i) {
    const int parent = i == 0 ? 0 : (i + 1) / 2; // in m.bodies
    const int level = static_cast<int>(std::log2(i + 1));
    const double size = std::pow(0.8, level), side = i % 2 == 0 ? 0.4 : -0.4;
    const Vec3 from = tip[static_cast<std::size_t>(parent)];
    const Vec3 to = from + size * (level % 2 == 0 ? Vec3(side, -1, 0) : Vec3(0, -1, side));
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(rod(name, size * size, from, to));
    tip.push_back(to);
    Joint j = revolute("hinge" + std::to_string(i), m.bodies[static_cast<std::size_t>(parent)].name, name,
                       from, level % 2 == 0 ? Vec3::UnitZ() : Vec3::UnitX());
    j.coordinates[0].spring = CoordinateSpring{3000 * size * size, 0};
    m.joints.push_back(j);
  }
  return m;
}

Mechanism spring_net(int side, double speed) {
  Mechanism m = on_a_hub("Net of " + std::to_string(side) + " x " + std::to_string(side), speed);
  const double cell = 1. / (side + 1);
  const auto at = [&](int i, int j) { return Vec3((i + 1) * cell - 0.5, 0, (j + 1) * cell - 0.5); };
  const auto name = [](int i, int j) { return "knot" + std::to_string(i) + "_" + std::to_string(j); };
  const auto tie = [&](const std::string& a, const std::string& b, const Vec3& from, const Vec3& to) {
    Force spring;
    spring.name = "cable" + std::to_string(m.forces.size());
    spring.type = ForceType::spring;
    spring.bodies = {a, b};
    spring.points = {from, to};
    spring.stiffness = 200;
    spring.free_length = cell / 1.1;
    m.forces.push_back(spring);
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      Body knot;
      knot.name = name(i, j);
      knot.mass = 1. / (side * side);
      knot.position = at(i, j);
      m.bodies.push_back(knot);
    }
  for (int i = 0; i < side; ++i)
    for (int j = -1; j < side; ++j) {
      const bool first = j < 0, last = j + 1 == side;
      tie(first ? "hub" : name(i, j), last ? "hub" : name(i, j + 1), at(i, j), at(i, j + 1));
      tie(first ? "hub" : name(j, i), last ? "hub" : name(j + 1, i), at(j, i), at(j + 1, i));
    }
  return m;
}

Mechanism cable_net(int side, double speed) {
  Mechanism m = on_a_hub("Cables of " + std::to_string(side) + " x " + std::to_string(side), speed);
  const double cell = 2. / (side + 1);
  const auto at = [&](int i, int j) {
    const double x = (i + 1) * cell - 1, z = (j + 1) * cell - 1;
    // A bowl, so that every cable sags alike; not quite even, or the loops would depend on each other.
    return Vec3(x, 0.4 * (x * x + z * z) + 0.05 * std::sin(2 * x + z), z);
  };
  const auto inside = [&](int i, int j) { return std::min(i, j) >= 0 && std::max(i, j) < side; };
  const auto name = [&](int i, int j) {
    return inside(i, j) ? "knot" + std::to_string(i) + "_" + std::to_string(j) : std::string("hub");
  };
  const auto tie = [&](int i, int j, int k, int l) {
    Joint cable;
    cable.name = "cable" + std::to_string(m.joints.size());
    cable.type = JointType::distance;
    cable.bodies = {name(i, j), name(k, l)};
    cable.points = {at(i, j), at(k, l)};
    m.joints.push_back(cable);
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      Body knot;
      knot.name = name(i, j);
      knot.mass = 1. / (side * side);
      knot.position = at(i, j);
      m.bodies.push_back(knot);
    }
  for (int i = 0; i < side; ++i)
    for (int j = -1; j < side; ++j) {
      tie(i, j, i, j + 1);
      tie(j, i, j + 1, i);
    }
  return m;
}

Mechanism rod_net(int side, double speed) {
  const Mechanism cables = cable_net(side, speed);
  Mechanism m = cables;
  m.name = "Rods of " + std::to_string(side) + " x " + std::to_string(side);
  std::erase_if(m.joints, [](const Joint& j) { return j.type == JointType::distance; });
  for (Body& knot : m.bodies)
    if (knot.name != "hub") knot.mass *= 0.1;
  for (const Joint& cable : cables.joints) {
    if (cable.type != JointType::distance) continue;
    m.bodies.push_back(rod(cable.name, 0.45 / (side * side), cable.points[0], cable.points[1]));
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      Joint ball;
      ball.name = cable.name + (end == 0 ? "a" : "b");
      ball.type = JointType::spherical;
      ball.bodies = {cable.bodies[end], cable.name};
      ball.at = cable.points[end];
      ball.coordinates.resize(3);
      m.joints.push_back(ball);
    }
  }
  return m;
}

} // namespace flyball::bench
