#include "tests/app/document_mechanisms.hpp"

#include "app/document/coordinate_image.hpp"
#include "engine/mechanism/validate.hpp"

#include <algorithm>

namespace flyball::test {
namespace {

class Builder {
 public:
  Builder(std::uint32_t seed, const RandomOptions& options) : dice_(seed), options_(options) {}

  Mechanism build() {
    m_.name = "Random";
    m_.gravity = {0, -9.80665, 0};
    spinning_ = dice_.chance(0.5);
    add_table();
    for (int i = dice_.below(4); i >= 0; --i)
      add_link();
    for (int i = dice_.below(4); i > 0; --i)
      add_force();
    if (dice_.chance(0.3)) add_loop();
    if (dice_.chance(0.3)) add_gear();
    return m_;
  }

 private:
  std::string name(char first, std::size_t i) const {
    return std::string(1, first) + static_cast<char>('a' + i);
  }

  Body& add_body(const std::string& name, const Vec3& position) {
    Body body;
    body.name = name;
    body.mass = dice_.between(0.5, 2);
    body.position = position;
    Mat3 a;
    for (double& entry : a.reshaped())
      entry = dice_.between(-0.15, 0.15);
    const Mat3 second = a * a.transpose();
    const Mat3 inertia = second.trace() * Mat3::Identity() - second;
    body.inertia = {inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2)};
    if (dice_.chance(0.6)) body.rotation = dice_.rotation();
    for (int i = dice_.below(3); i > 0; --i)
      body.shapes.push_back(shape());
    m_.bodies.push_back(body);
    return m_.bodies.back();
  }

  Shape shape() {
    Shape shape;
    shape.type = static_cast<ShapeType>(dice_.below(4));
    if (shape.type == ShapeType::box)
      shape.size = dice_.box(0.1).cwiseAbs();
    else
      shape.radius = dice_.between(0.01, 0.1);
    if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule) {
      shape.from = dice_.box(1);
      shape.to = dice_.box(1);
    } else if (dice_.chance(0.5)) {
      shape.at = dice_.box(1);
    }
    return shape;
  }

  void add_table() {
    Body& table = add_body("table", {0, 0, 0});
    table.inertia = {0.3, 0.3, 0.3, 0, 0, 0};
    Joint joint;
    joint.name = "spin";
    joint.bodies = {"ground", "table"};
    joint.axis = {0, dice_.between(0.5, 2), 0};
    joint.coordinates.resize(1);
    if (spinning_)
      joint.coordinates[0].drive = Drive{dice_.between(-3, 3)};
    else
      joint.coordinates[0].spring = CoordinateSpring{100, 0.1};
    m_.joints.push_back(joint);
  }

  void add_link() {
    const std::string parent = dice_.one_of(m_.bodies).name;
    const std::size_t i = m_.bodies.size();
    const Body& body = add_body(name('b', i), dice_.box(0.7));
    Joint joint;
    joint.name = name('j', i);
    joint.type = static_cast<JointType>(dice_.below(8));
    joint.bodies = {parent, body.name};
    if (dice_.chance(0.3)) std::swap(joint.bodies[0], joint.bodies[1]);
    joint.at = body.position + dice_.box(0.3);
    if (has_axis(joint.type)) {
      const double length = dice_.between(0.3, 1.7);
      joint.axis = length * dice_.direction();
    }
    if (has_axis2(joint.type)) joint.axis2 = joint.axis.unitOrthogonal() + 0.3 * joint.axis;
    joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(joint.type)));
    for (std::size_t k = 0; k < joint.coordinates.size(); ++k)
      add_to(joint, k);
    m_.joints.push_back(joint);
  }

  void add_to(Joint& joint, std::size_t k) {
    Coordinate& c = joint.coordinates[k];
    const bool component = joint.type == JointType::spherical || joint.type == JointType::free;
    const bool as_before = component && options_.alike && k % 3 != 0;
    c.drawn = dice_.between(-0.4, 0.4);
    const double stiffness = as_before ? joint.coordinates[k - 1].spring->stiffness : dice_.between(150, 400);
    c.spring = CoordinateSpring{stiffness, c.drawn + dice_.between(-0.1, 0.1)};
    c.damping = as_before ? joint.coordinates[k - 1].damping : dice_.between(0, 3);
    if ((component && options_.alike) || dice_.chance(0.6)) return;
    c.stop = Stop{{}, {}, dice_.between(200, 400)};
    if (dice_.chance(0.7)) c.stop->lower = c.drawn + dice_.between(-0.1, 0.02);
    if (!c.stop->lower || dice_.chance(0.5)) c.stop->upper = c.drawn + dice_.between(0.03, 0.1);
  }

  void add_force() {
    Force force;
    force.name = name('f', m_.forces.size());
    force.type = static_cast<ForceType>(dice_.below(6));
    const Body& body = dice_.one_of(m_.bodies);
    if (force.type == ForceType::spring) {
      // From the ground it would turn with the table.
      force.bodies = {spinning_ || dice_.chance(0.5) ? "table" : "ground", m_.bodies.back().name};
      force.points = {dice_.box(0.5), dice_.box(0.5)};
      force.stiffness = dice_.between(10, 50);
      if (dice_.chance(0.5)) force.free_length = dice_.between(0.1, 1);
      force.damping = dice_.between(0, 2);
    } else if (force.type == ForceType::bearing) {
      hold_in_bearing(force);
    } else {
      force.body = body.name;
      if (dice_.chance(0.7)) force.at = body.position + dice_.box(0.2);
      if (force.type == ForceType::drag) {
        force.linear = dice_.between(0, 0.5);
        force.quadratic = dice_.between(0, 0.5);
      } else if (force.type == ForceType::vane) {
        force.area = dice_.between(0.01, 0.1);
        force.normal = dice_.direction();
        if (dice_.chance(0.5)) force.chord = force.normal.cross(dice_.direction());
      } else {
        force.vector = dice_.box(2);
        force.frame = spinning_ || dice_.chance(0.5) ? ForceFrame::body : ForceFrame::world;
      }
    }
    m_.forces.push_back(force);
  }

  // Of two rows or six, stiff and coupled but for a tenth not symmetric.
  void hold_in_bearing(Force& force) {
    force.bodies = {spinning_ || dice_.chance(0.5) ? "table" : "ground", m_.bodies.back().name};
    force.at = m_.bodies.back().position + dice_.box(0.2);
    force.axis = dice_.direction();
    if (dice_.chance(0.5)) force.x_axis = force.axis.cross(dice_.direction());
    const std::size_t size = dice_.chance(0.5) ? 6 : 2;
    for (std::size_t i = 0; i < size * size; ++i) {
      const bool diagonal = i % (size + 1) == 0;
      force.bearing_stiffness.push_back(diagonal ? dice_.between(10, 50) : dice_.between(-1, 1));
      force.bearing_damping.push_back(diagonal ? dice_.between(1, 2) : dice_.between(-0.1, 0.1));
    }
  }

  void add_loop() {
    if (m_.bodies.size() < 3) return;
    Joint joint;
    joint.name = "loop";
    joint.type = JointType::distance;
    joint.bodies = {m_.bodies[m_.bodies.size() - 2].name, m_.bodies.back().name};
    joint.points = {dice_.box(0.5), dice_.box(0.5)};
    if (dice_.chance(0.5)) joint.length = drawn_distance(joint.points);
    m_.joints.push_back(joint);
  }

  void add_gear() {
    std::vector<std::string> ends;
    for (std::size_t j = 1; j < m_.joints.size(); ++j) {
      if (options_.alike && m_.joints[j].type == JointType::free) continue; // along one axis of the three
      for (int i = 0; i < coordinate_count(m_.joints[j].type); ++i)
        if (!is_rotation_vector(m_.joints[j].type, i)) ends.push_back(coordinate_name(m_.joints[j], i));
    }
    if (ends.size() < 2) return;
    Joint gear;
    gear.name = "gear";
    gear.type = JointType::gear;
    gear.joints = {dice_.one_of(ends), dice_.one_of(ends)};
    gear.ratio = dice_.between(0.5, 1.5) * (dice_.chance(0.5) ? 1 : -1);
    if (dice_.chance(0.5)) gear.offset = drawn_offset(m_, gear) + 0.02;
    if (gear.joints[0] != gear.joints[1]) m_.joints.push_back(gear);
  }

  Dice dice_;
  RandomOptions options_;
  Mechanism m_;
  bool spinning_ = false;
};

} // namespace

Mechanism random_mechanism(std::uint32_t seed, const RandomOptions& options) {
  return Builder(seed, options).build();
}

Selection everything_of(const Mechanism& mechanism) {
  Selection all;
  for (const Body& body : mechanism.bodies)
    all.add({PartKind::body, body.name});
  for (const Joint& joint : mechanism.joints)
    all.add({PartKind::joint, joint.name});
  for (const Force& force : mechanism.forces)
    all.add({PartKind::force, force.name});
  return all;
}

bool check_settles_as_image(const Mechanism& first, const Mechanism& second, const Isometry& isometry,
                            const std::function<std::string(const std::string&)>& rename) {
  validate(first);
  REQUIRE_NOTHROW(validate(second));
  const Solution a = Analysis(first).solve(), b = Analysis(second).solve();
  if (a.status != Status::converged) return false;
  INFO(a.message << "\n" << b.message);
  REQUIRE(b.status == Status::converged);
  constexpr double tolerance = 1e-8;
  for (std::size_t i = 0; i < first.bodies.size(); ++i) {
    const std::string name = rename(first.bodies[i].name);
    const int j = body_index(second, name);
    INFO(name);
    REQUIRE(j >= 0);
    // Three points of the body and where they end up.
    for (int k = 0; k < 3; ++k) {
      const Vec3 point = first.bodies[i].position + Vec3::Unit(k);
      const Vec3 there = carried_point(first, a.poses, static_cast<int>(i), point);
      const Vec3 image = carried_point(second, b.poses, j, isometry.point(point));
      CHECK((isometry.point(there) - image).norm() < tolerance);
    }
  }
  for (const CoordinateSolution& c : a.coordinates) {
    const int j = joint_index(first, c.joint);
    REQUIRE(j >= 0);
    const auto images = images_of_coordinates(first.joints[static_cast<std::size_t>(j)].type, isometry);
    const CoordinateImage& to = images[static_cast<std::size_t>(c.index)];
    if (to.mixed) continue;
    const auto found = std::ranges::find_if(b.coordinates, [&](const CoordinateSolution& other) {
      return other.joint == rename(c.joint) && other.index == static_cast<int>(to.index);
    });
    REQUIRE(found != b.coordinates.end());
    INFO(c.joint << "." << c.index);
    CHECK(std::abs(found->value - to.sign * c.value) < tolerance);
  }
  return true;
}

} // namespace flyball::test
