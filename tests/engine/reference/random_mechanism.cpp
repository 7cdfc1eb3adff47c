#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/support/dice.hpp"

#include <algorithm>
#include <set>

namespace flyball::reference {

namespace {

std::string numbered(std::string stem, int i) {
  return stem += std::to_string(i);
}

class Builder {
 public:
  Builder(std::uint32_t seed, const RandomOptions& options)
      : dice_(seed), polar_dice_(seed + 77), options_(options) {
    mechanism_.name = "random";
    tree_types_ = options.tree_types;
    loop_types_ = options.loop_types;
    if (!options.parallel_axes) return;
    const std::set<JointType> plane{JointType::revolute, JointType::prismatic, JointType::planar,
                                    JointType::fixed,    JointType::distance,  JointType::gear};
    const auto spatial = [&](JointType type) { return !plane.contains(type); };
    std::erase_if(tree_types_, spatial);
    std::erase_if(loop_types_, spatial);
  }

  Mechanism build() {
    const int bodies = options_.bodies > 0 ? options_.bodies : 1 + dice_.below(8);
    main_axis_ = dice_.direction();
    main_point_ = dice_.box(0.3);
    mechanism_.gravity = 9.81 * dice_.sign() * main_axis_;
    if (!options_.steady || options_.drives == RandomDrives::none) mechanism_.gravity = dice_.box(10);
    for (int i = 0; i < bodies; ++i)
      add_body(i);
    for (int i = 0; i < options_.loops; ++i)
      add_loop(i);
    if (options_.forces) add_forces();
    if (options_.air && !options_.conservative) add_air();
    return mechanism_;
  }

 private:
  bool anchored() const { return options_.steady && options_.drives == RandomDrives::root; }
  Vec3 turning_axis() { return options_.parallel_axes ? Vec3(main_axis_ * dice_.sign()) : dice_.direction(); }
  Vec3 sliding_axis() { return options_.parallel_axes ? dice_.across(main_axis_) : dice_.direction(); }
  const Body& body(int i) const { return mechanism_.bodies[static_cast<std::size_t>(i)]; }
  std::string body_name(int i) const { return i < 0 ? std::string(ground_name) : body(i).name; }
  Vec3 near(int i) { return (i < 0 ? Vec3(Vec3::Zero()) : body(i).position) + dice_.box(0.2); }

  void add_body(int i) {
    int parent = i == 0 ? -1 : dice_.below(i);
    if (i > 0 && !anchored() && dice_.chance(0.15)) parent = -1;
    Body b;
    b.name = numbered("b", i);
    b.position = near(parent) + 0.4 * dice_.direction();
    if (options_.rotated_bodies && dice_.chance(0.5)) b.rotation = dice_.rotation();
    const bool no_mass = options_.massless && i > 0 && dice_.chance(0.15);
    if (!no_mass) b.mass = dice_.between(0.3, 4);
    if (!no_mass || dice_.chance(0.3)) b.inertia = random_inertia();
    mechanism_.bodies.push_back(b);

    const bool root = i == 0 && options_.drives == RandomDrives::root;
    JointType type = dice_.one_of(tree_types_);
    if (root)
      type = dice_.chance(0.2) && !options_.parallel_axes ? JointType::cylindrical : JointType::revolute;
    Joint joint = make_joint(numbered("j", i), type, parent, i);
    if (root) {
      joint.axis = main_axis_;
      joint.at = main_point_;
    }
    for (int c = 0; c < coordinate_count(type); ++c) {
      const bool driven = (root && c == 0) || (options_.drives == RandomDrives::several &&
                                               !is_rotation_vector(type, c) && dice_.chance(0.35));
      Coordinate& coordinate = joint.coordinates[static_cast<std::size_t>(c)];
      if (driven)
        coordinate.drive =
            Drive{dice_.sign() * (is_angle(type, c) ? dice_.between(1, 8) : dice_.between(0.1, 1))};
      else
        add_spring(coordinate, is_angle(type, c), options_.spring_share);
    }
    mechanism_.joints.push_back(joint);
  }

  // Of a body with mass along three random axes, hence within the triangle inequality.
  std::array<double, 6> random_inertia() {
    const Vec3 spread(dice_.between(0.002, 0.05), dice_.between(0.002, 0.05), dice_.between(0.002, 0.05));
    const Mat3 r = dice_.rotation().toRotationMatrix();
    const Vec3 principal(spread.y() + spread.z(), spread.x() + spread.z(), spread.x() + spread.y());
    const Mat3 m = r * principal.asDiagonal() * r.transpose();
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  }

  // Between two bodies in random order, its coordinates labelled but without forces.
  Joint make_joint(const std::string& name, JointType type, int a, int b) {
    Joint joint;
    joint.name = name;
    joint.type = type;
    if (dice_.chance(0.35)) std::swap(a, b);
    joint.bodies = {body_name(a), body_name(b)};
    joint.at = (a < 0   ? near(b)
                : b < 0 ? near(a)
                        : Vec3((body(a).position + body(b).position) / 2)) +
               dice_.box(0.1);
    const double length = dice_.between(0.5, 2);
    joint.axis = length * (type == JointType::prismatic ? sliding_axis() : turning_axis());
    if (type == JointType::universal || type == JointType::planar) joint.axis2 = dice_.across(joint.axis);
    if (type == JointType::universal && options_.skew_universals)
      joint.axis2 = (joint.axis2 + dice_.between(-0.5, 0.5) * joint.axis.normalized()).normalized();
    joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(type)));
    for (Coordinate& c : joint.coordinates)
      if (dice_.chance(0.5)) c.drawn = dice_.between(-1, 1);
    return joint;
  }

  void add_spring(Coordinate& c, bool angle, double share) {
    const double unit = angle ? 1 : 0.2, scale = angle ? 1 : 20;
    if (dice_.chance(share))
      c.spring = CoordinateSpring{scale * dice_.between(5, 50), c.drawn + unit * dice_.between(-0.4, 0.4)};
    if (options_.stops && dice_.chance(0.2)) {
      Stop stop;
      if (dice_.chance(0.7)) stop.lower = c.drawn + unit * dice_.between(-0.6, 0.05);
      if (!stop.lower || dice_.chance(0.5)) stop.upper = c.drawn + unit * dice_.between(0.06, 0.6);
      stop.stiffness = scale * dice_.between(20, 200);
      c.stop = stop;
    }
    if (!options_.conservative && dice_.chance(0.4)) c.damping = dice_.between(0.1, 2);
  }

  void add_loop(int i) {
    const JointType type = dice_.one_of(loop_types_);
    const std::string name = numbered("loop", i);
    if (type == JointType::gear) {
      add_gear(name);
      return;
    }
    const int count = static_cast<int>(mechanism_.bodies.size());
    const int lowest = anchored() ? 0 : -1;
    if (count - lowest < 2) return;
    const int a = lowest + dice_.below(count - lowest);
    int b = lowest + dice_.below(count - lowest - 1);
    if (b >= a) ++b;
    Joint joint = make_joint(name, type, a, b);
    if (type == JointType::distance) {
      joint.points = {near(body_index(mechanism_, joint.bodies[0])),
                      near(body_index(mechanism_, joint.bodies[1]))};
      if (dice_.chance(0.5)) joint.length = (joint.points[1] - joint.points[0]).norm();
      joint.at = Vec3::Zero();
    }
    for (int c = 0; c < coordinate_count(type); ++c)
      add_spring(joint.coordinates[static_cast<std::size_t>(c)], is_angle(type, c),
                 options_.spring_share / 2);
    if (options_.mark_cuts && type != JointType::distance) joint.cut = true;
    mechanism_.joints.push_back(joint);
  }

  // Between coordinates of tree joints that no other gear takes; at most one of them driven, which then
  // drives the other.
  void add_gear(const std::string& name) {
    std::vector<CoordinateReference> candidates;
    for (int j = 0; j < static_cast<int>(mechanism_.bodies.size()); ++j) {
      const Joint& joint = mechanism_.joints[static_cast<std::size_t>(j)];
      for (int c = 0; c < coordinate_count(joint.type); ++c) {
        const bool driven = joint.coordinates[static_cast<std::size_t>(c)].drive.has_value();
        if (is_rotation_vector(joint.type, c) || geared_.contains({j, c}) ||
            (driven && options_.drives != RandomDrives::several))
          continue;
        candidates.push_back({j, c});
      }
    }
    if (candidates.size() < 2) return;
    const auto take = [&] {
      const auto i = dice_.below(static_cast<int>(candidates.size()));
      const CoordinateReference r = candidates[static_cast<std::size_t>(i)];
      candidates.erase(candidates.begin() + i);
      return r;
    };
    const CoordinateReference a = take(), b = take();
    const auto coordinate = [&](const CoordinateReference& r) -> Coordinate& {
      return mechanism_.joints[static_cast<std::size_t>(r.joint)]
          .coordinates[static_cast<std::size_t>(r.coordinate)];
    };
    const auto reference = [&](const CoordinateReference& r) {
      return coordinate_name(mechanism_.joints[static_cast<std::size_t>(r.joint)], r.coordinate);
    };
    if (coordinate(a).drive && coordinate(b).drive) return;
    if (coordinate(a).drive || coordinate(b).drive)
      for (const CoordinateReference& r : {a, b}) {
        coordinate(r).spring.reset();
        coordinate(r).stop.reset();
      }
    geared_.insert({a.joint, a.coordinate});
    geared_.insert({b.joint, b.coordinate});
    Joint gear;
    gear.name = name;
    gear.type = JointType::gear;
    gear.joints = {reference(a), reference(b)};
    gear.ratio = dice_.sign() * dice_.between(0.3, 3);
    if (dice_.chance(0.5)) gear.offset = coordinate(b).drawn - gear.ratio * coordinate(a).drawn;
    mechanism_.joints.push_back(gear);
  }

  void add_forces() {
    const int count = static_cast<int>(mechanism_.bodies.size());
    for (int i = 0; i < 1 + dice_.below(3); ++i) {
      const int kind = dice_.below(4);
      Force force;
      force.name = numbered("force", i);
      if (kind <= 1) {
        add_point_spring(force, count);
        continue;
      }
      force.body = body_name(dice_.below(count));
      if (dice_.chance(0.6)) force.at = near(body_index(mechanism_, force.body));
      if (kind == 2 && !options_.conservative) {
        force.type = ForceType::drag;
        force.linear = dice_.between(0, 2);
        force.quadratic = dice_.between(0, 1);
      } else {
        force.type = !options_.conservative && dice_.chance(0.5) ? ForceType::torque : ForceType::force;
        force.frame = !options_.conservative && dice_.chance(0.5) ? ForceFrame::body : ForceFrame::world;
        const bool along_axis = anchored() && force.frame == ForceFrame::world;
        force.vector = along_axis ? Vec3(main_axis_ * dice_.between(-5, 5)) : dice_.box(5);
      }
      mechanism_.forces.push_back(force);
    }
  }

  // In a wind, along the axis where the balance is to be steady, or with a body that turns the air.
  void add_air() {
    const int count = static_cast<int>(mechanism_.bodies.size());
    for (int i = 0; i < 2; ++i) {
      Force vane;
      vane.name = numbered("vane", i);
      vane.type = ForceType::vane;
      vane.body = body_name(dice_.below(count));
      vane.at = near(body_index(mechanism_, vane.body));
      vane.area = dice_.between(0.2, 1);
      vane.normal = dice_.direction();
      if (dice_.chance(0.5)) vane.chord = vane.normal.cross(dice_.direction());
      vane.cn = dice_.between(0.5, 3);
      vane.cd = dice_.between(0, 0.5);
      if (vane.chord && polar_dice_.chance(0.5)) add_polar(vane);
      mechanism_.forces.push_back(vane);
    }
    mechanism_.air.density = dice_.between(1, 2);
    if (dice_.chance(0.5))
      mechanism_.air.turns_with = body_name(anchored() ? 0 : dice_.below(count));
    else
      mechanism_.air.wind = anchored() ? Vec3(main_axis_ * dice_.between(-3, 3)) : dice_.box(3);
  }

  // Of any shape, the same from behind on either side.
  void add_polar(Force& vane) {
    vane.lift = vane.drag = 0;
    const std::string size = std::to_string(polar_dice_.between(0.5, 2));
    vane.formulas = {{"drag", "0.1 + " + size + "*(1 - cos(2*incidence))"},
                     {"lift", polar_dice_.chance(0.5)
                                  ? size + "*sin(incidence + 0.1)"
                                  : "table(incidence, [-180 deg, 0], [-90 deg, 0.1], [-15 deg, -" + size +
                                        "], [0, 0.2], [15 deg, " + size +
                                        "], [90 deg, -0.2], [180 deg, 0])"}};
  }

  void add_point_spring(Force& force, int count) {
    const int a = dice_.below(count);
    int b = dice_.below(count + 1) - 1; // ground among them
    if (b == a) b = -1;
    force.type = ForceType::spring;
    force.bodies = {body_name(a), body_name(b)};
    const double height = dice_.between(-0.5, 0.5);
    force.points = {near(a), b < 0 && anchored() ? Vec3(main_point_ + height * main_axis_) : near(b)};
    if (dice_.chance(0.5)) {
      std::swap(force.bodies[0], force.bodies[1]);
      std::swap(force.points[0], force.points[1]);
    }
    force.stiffness = dice_.between(20, 300);
    if (dice_.chance(0.2))
      force.free_length = 0;
    else if (dice_.chance(0.6))
      force.free_length = (force.points[1] - force.points[0]).norm() * dice_.between(0.7, 1.3);
    if (!options_.conservative && dice_.chance(0.5)) force.damping = dice_.between(0.5, 5);
    mechanism_.forces.push_back(force);
  }

  test::Dice dice_, polar_dice_; // what has polars is else as it was without
  RandomOptions options_;
  Mechanism mechanism_;
  std::vector<JointType> tree_types_, loop_types_;
  Vec3 main_axis_ = Vec3::UnitZ(), main_point_ = Vec3::Zero(); // of the root drive
  std::set<std::pair<int, int>> geared_;                       // joint, coordinate
};

} // namespace

Mechanism random_mechanism(std::uint32_t seed, const RandomOptions& options) {
  // Now and then the parts drawn contradict each other, as where a driven joint lands in a rigid loop: draw
  // again.
  for (std::uint32_t attempt = 0;; ++attempt) {
    Mechanism mechanism = Builder(seed + 100000 * attempt, options).build();
    if (attempt == 20 || find_mistakes(mechanism).empty()) return mechanism;
  }
}

Mechanism random_sprung_mechanism(std::uint32_t seed) {
  RandomOptions options;
  options.loops = static_cast<int>(seed % 3);
  options.massless = false;
  options.spring_share = 1;
  options.rotated_bodies = seed % 2 == 0;
  return random_mechanism(seed, options);
}

Mechanism with_damper_laws(Mechanism mechanism) {
  for (Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      Coordinate& c = joint.coordinates[i];
      if (c.damping == 0 || is_rotation_vector(joint.type, static_cast<int>(i))) continue;
      const std::string damping = std::to_string(c.damping);
      joint.formulas.push_back(
          {coordinate_key(joint, i, "damping_force"), is_angle(joint.type, static_cast<int>(i))
                                                          ? damping + " N m s*rate + 0.5 N m s^3*rate^3"
                                                          : damping + " N s/m*rate + 2 N s^3/m^3*rate^3"});
      c.damping = 0;
      c.damping_force = 0;
    }
  return mechanism;
}

} // namespace flyball::reference
