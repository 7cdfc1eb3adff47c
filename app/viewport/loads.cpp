#include "app/viewport/loads.hpp"

#include "engine/mechanism/damped.hpp"
#include "engine/system/air_force.hpp"
#include "engine/system/elastic_force.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>

namespace flyball {

namespace {

PartId part_at(PartKind kind, std::size_t index) {
  return {kind, static_cast<int>(index)};
}

// Collects the loads of one mechanism, or of one body of it.
class Collector {
 public:
  Collector(const Assembly& assembly, const Solution& solution, std::span<const AngularMotion> turning,
            int body, const Quat& turn)
      : assembly_(assembly), mechanism_(assembly.mechanism), solution_(solution), turning_(turning),
        body_(body), turn_(turn) {
    for (std::size_t i = 0; i < mechanism_.joints.size(); ++i)
      joints_.emplace(mechanism_.joints[i].name, i);
  }

  void reactions() {
    find_acting();
    for (const Reaction& r : solution_.reactions) {
      const auto found = joints_.find(r.joint);
      if (found == joints_.end()) continue;
      const std::size_t j = found->second;
      const Joint& joint = mechanism_.joints[j];
      const auto [parent, child] = assembly_.joint_bodies[j];
      if (!of_body(parent) && !of_body(child)) continue;
      const bool on_parent = body_ >= 0 && body_ == parent;
      const double sign = on_parent ? -1 : 1;
      // A link pulls along its line: there each body feels it at its own end.
      const Vec3 at = on_parent && joint.type == JointType::distance
                          ? assembly_.point(parent, joint.points[0])
                          : reaction_place(assembly_, j);
      Vec3 force = turn_ * (sign * r.force), torque = turn_ * (sign * r.torque);
      split(j, at, sign, force, torque);
      add(LoadKind::reaction, false, at, force, part_at(PartKind::joint, j));
      add(LoadKind::reaction, true, at, torque, part_at(PartKind::joint, j));
    }
  }

  // The first body feels the opposite at the same place.
  void bearings() {
    for (const BearingForce& b : solution_.bearings) {
      const int index = force_index(mechanism_, b.bearing);
      if (index < 0) continue;
      const auto f = static_cast<std::size_t>(index);
      const auto [first, second] = assembly_.force_bodies[f];
      if (!of_body(first) && !of_body(second)) continue;
      const double sign = body_ >= 0 && body_ == first ? -1 : 1;
      const Vec3 at = bearing_place(assembly_, f);
      add(LoadKind::reaction, false, at, turn_ * (sign * b.force), part_at(PartKind::force, f));
      add(LoadKind::reaction, true, at, turn_ * (sign * b.torque), part_at(PartKind::force, f));
    }
  }

  void drives() {
    for (const DriveTorque& t : solution_.drive_torques) {
      along_coordinate(LoadKind::drive, t.joint, t.index, given_by(t));
      along_coordinate(LoadKind::applied, t.joint, t.index, given_by_load(t));
    }
  }

  // What springs and stops of joints exert along their coordinates.
  void joint_springs() {
    for (const CoordinateSolution& c : solution_.coordinates)
      if (const double force = spring_force(c); force != 0)
        along_coordinate(LoadKind::spring, c.joint, c.index, force);
  }

  void springs() {
    for (std::size_t f = 0; f < mechanism_.forces.size(); ++f) {
      const Force& force = mechanism_.forces[f];
      if (force.type != ForceType::spring) continue;
      const auto [first, second] = assembly_.force_bodies[f];
      const Vec3 a = assembly_.point(first, force.points[0]), b = assembly_.point(second, force.points[1]);
      const double length = (b - a).stableNorm();
      if (!(length > 0)) continue;
      const Vec3 along = (b - a) / length;
      const double free = force.free_length.value_or((force.points[1] - force.points[0]).stableNorm());
      const double stretching = is_damped(force) ? along.dot(velocity(second, b) - velocity(first, a)) : 0;
      const Vec3 pull = (elastic_force(mechanism_, force, length - free).force +
                         damping_force(mechanism_, force, stretching)) *
                        along;
      if (first >= 0 && of_body(first)) add(LoadKind::spring, false, a, pull, part_at(PartKind::force, f));
      if (second >= 0 && of_body(second)) add(LoadKind::spring, false, b, -pull, part_at(PartKind::force, f));
    }
  }

  void applied() {
    for (std::size_t f = 0; f < mechanism_.forces.size(); ++f) {
      const Force& force = mechanism_.forces[f];
      if (force.type != ForceType::force && force.type != ForceType::torque) continue;
      const int body = assembly_.force_bodies[f][0];
      if (body < 0 || !of_body(body)) continue;
      const Quat& rotation = assembly_.poses[static_cast<std::size_t>(body)].rotation;
      add(LoadKind::applied, force.type == ForceType::torque, acts_at(force, body),
          force.frame == ForceFrame::world ? force.vector : Vec3(rotation * force.vector),
          part_at(PartKind::force, f));
    }
  }

  // What turns the air feels the opposite at the same points.
  void air() {
    const Air& air = mechanism_.air;
    const int turner = air.turns_with.empty() ? -1 : body_index(mechanism_, air.turns_with);
    for (std::size_t f = 0; f < mechanism_.forces.size(); ++f) {
      const Force& force = mechanism_.forces[f];
      const int body = assembly_.force_bodies[f][0];
      if (!is_of_air(force.type) || body < 0) continue;
      const auto b = static_cast<std::size_t>(body);
      const Vec3 at = acts_at(force, body),
                 flow = (turner < 0 ? air.wind : velocity(turner, at)) - velocity(body, at);
      const Quat turned =
          assembly_.poses[b].rotation * mechanism_.bodies[b].rotation.normalized().conjugate();
      BodyForceParameters numbers;
      set_air_force(force, air, NumberReader<double>(), numbers);
      const Vec3 push = air_force<double>(numbers, turned.toRotationMatrix(), flow);
      if (of_body(body)) add(LoadKind::air, false, at, push, part_at(PartKind::force, f));
      if (turner >= 0 && of_body(turner)) add(LoadKind::air, false, at, -push, part_at(PartKind::force, f));
    }
  }

  void weight() {
    const auto b = static_cast<std::size_t>(body_);
    add(LoadKind::weight, false, assembly_.poses[b].position, mechanism_.bodies[b].mass * mechanism_.gravity,
        part_at(PartKind::body, b));
  }

  void inertia() {
    for (std::size_t b = 0; b < mechanism_.bodies.size(); ++b) {
      if (!of_body(static_cast<int>(b)) || !has_motion(b)) continue;
      const Vec3& at = assembly_.poses[b].position;
      add(LoadKind::inertia, false, at,
          turn_ * (-mechanism_.bodies[b].mass * solution_.centres[b].acceleration),
          part_at(PartKind::body, b));
      const Mat3 rotation = assembly_.poses[b].rotation.toRotationMatrix();
      const Mat3 tensor = rotation * tensor_of(mechanism_.bodies[b]) * rotation.transpose();
      const Vec3 w = turn_ * turning_[b].velocity, dw = turn_ * turning_[b].acceleration;
      add(LoadKind::inertia, true, at, -(tensor * dw + w.cross(tensor * w)), part_at(PartKind::body, b));
    }
  }

  std::vector<Load> loads;

 private:
  bool of_body(int body) const { return body_ < 0 || body == body_; }
  bool has_motion(std::size_t body) const {
    return body < solution_.centres.size() && body < turning_.size();
  }

  static Mat3 tensor_of(const Body& body) {
    const auto& i = body.inertia;
    return (Mat3() << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2]).finished();
  }

  Vec3 acts_at(const Force& force, int body) const {
    return assembly_.point(body,
                           force.at.value_or(mechanism_.bodies[static_cast<std::size_t>(body)].position));
  }

  Vec3 velocity(int body, const Vec3& at) const {
    const auto b = static_cast<std::size_t>(body);
    if (body < 0 || !has_motion(b)) return Vec3::Zero();
    return turn_ * solution_.centres[b].velocity +
           (turn_ * turning_[b].velocity).cross(at - assembly_.poses[b].position);
  }

  // Of the spring and the stop of a joint's coordinate, along it.
  double spring_force(const CoordinateSolution& c) const {
    const auto found = joints_.find(c.joint);
    if (found == joints_.end()) return 0;
    const Joint& joint = mechanism_.joints[found->second];
    const auto i = static_cast<std::size_t>(c.index);
    if (i >= joint.coordinates.size()) return 0;
    const Coordinate& coordinate = joint.coordinates[i];
    double force = 0;
    if (const auto& spring = coordinate.spring)
      force -= elastic_force(mechanism_, joint, c.index, c.value - spring->free).force;
    if (const auto& stop = coordinate.stop) {
      if (stop->lower) force += stop->stiffness * std::max(*stop->lower - c.value, 0.);
      if (stop->upper) force -= stop->stiffness * std::max(c.value - *stop->upper, 0.);
    }
    return force;
  }

  // Of a drive by torque, what it gives and what its load does, which in the steady state often leave
  // nothing.
  static double given_by(const DriveTorque& t) { return t.given ? t.given->torque : t.value; }
  static double given_by_load(const DriveTorque& t) { return t.given ? t.value - t.given->torque : 0; }

  // What acts along a coordinate of a hinge or slide, whose guide itself does nothing there.
  struct Acting {
    LoadKind kind = LoadKind::drive;
    double value = 0; // along it, on the child
    PartId part;
  };
  // By joint and coordinate; found once, where reactions are asked for.
  void find_acting() {
    acting_.resize(mechanism_.joints.size());
    const auto add_at = [&](std::size_t j, int index, LoadKind kind, double value, std::size_t of) {
      acting_[j].push_back({index, {kind, value, part_at(PartKind::joint, of)}});
    };
    for (const DriveTorque& t : solution_.drive_torques)
      if (const auto at = joints_.find(t.joint); at != joints_.end()) {
        add_at(at->second, t.index, LoadKind::drive, given_by(t), at->second);
        if (const double load = given_by_load(t); load != 0)
          add_at(at->second, t.index, LoadKind::applied, load, at->second);
      }
    for (const CoordinateSolution& c : solution_.coordinates)
      if (const auto at = joints_.find(c.joint); at != joints_.end())
        add_at(at->second, c.index, LoadKind::spring, spring_force(c), at->second);
    for (const GearReaction& g : solution_.gears) {
      const auto gear = joints_.find(g.joint);
      if (gear == joints_.end()) continue;
      for (const std::size_t end : {0u, 1u}) {
        const CoordinateReference at =
            find_coordinate(mechanism_, mechanism_.joints[gear->second].joints[end]);
        if (at.joint >= 0)
          add_at(static_cast<std::size_t>(at.joint), at.coordinate, LoadKind::gear, end == 0 ? g.a : g.b,
                 gear->second);
      }
    }
  }

  // `whole`: of the reaction along it. What drive, spring and gears leave of that is a damper's or
  // friction's.
  std::vector<Acting> acting_along(std::size_t j, int index, double whole) const {
    constexpr double rounding = 1e-9; // of the largest
    std::vector<Acting> all;
    for (const auto& [coordinate, each] : acting_[j])
      if (coordinate == index) all.push_back(each);
    double rest = whole, largest = std::abs(whole);
    for (const Acting& each : all) {
      rest -= each.value;
      largest = std::max(largest, std::abs(each.value));
    }
    if (std::abs(rest) > rounding * largest)
      all.push_back({LoadKind::damper, rest, part_at(PartKind::joint, j)});
    return all;
  }

  // Takes out of a body's reaction what acts along the joint's coordinates, which is added by itself; of the
  // mechanism it stays in, beside gears and dampers by themselves (drives and springs are added for all
  // joints).
  void split(std::size_t j, const Vec3& at, double sign, Vec3& force, Vec3& torque) {
    const Joint& joint = mechanism_.joints[j];
    if (joint.type != JointType::revolute && joint.type != JointType::prismatic &&
        joint.type != JointType::cylindrical)
      return; // there the directions of coordinates are not those of the guide's own loads
    const auto [parent, child] = assembly_.joint_bodies[j];
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      const CoordinateAxis along = coordinate_axis(joint, i);
      const Vec3 axis = assembly_.vector(along.end == 0 ? parent : child, along.axis);
      Vec3& vector = along.angle ? torque : force;
      const double whole = vector.dot(axis) * sign;
      for (const Acting& each : acting_along(j, static_cast<int>(i), whole)) {
        if (body_ < 0 &&
            (each.kind == LoadKind::drive || each.kind == LoadKind::applied || each.kind == LoadKind::spring))
          continue;
        add(each.kind, along.angle, at, sign * each.value * axis, each.part);
      }
      if (body_ >= 0) vector -= sign * whole * axis;
    }
  }

  // On the joint's child.
  void along_coordinate(LoadKind kind, const std::string& name, int index, double value) {
    const auto found = joints_.find(name);
    if (found == joints_.end()) return;
    const Load load = load_along(assembly_, kind, found->second, static_cast<std::size_t>(index), value);
    add(kind, load.moment, load.at, load.vector, load.part);
  }

  void add(LoadKind kind, bool moment, const Vec3& at, const Vec3& vector, PartId part) {
    if (vector.stableNorm() > 0) loads.push_back({kind, moment, at, vector, part});
  }

  const Assembly& assembly_;
  const Mechanism& mechanism_;
  const Solution& solution_;
  std::span<const AngularMotion> turning_;
  int body_;
  Quat turn_;
  std::unordered_map<std::string_view, std::size_t> joints_;
  std::vector<std::vector<std::pair<int, Acting>>> acting_;
};

} // namespace

Load load_along(const Assembly& assembly, LoadKind kind, std::size_t joint, std::size_t index, double value) {
  const Joint& of = assembly.mechanism.joints[joint];
  const CoordinateAxis along = coordinate_axis(of, index);
  const auto [parent, child] = assembly.joint_bodies[joint];
  return {kind, along.angle, assembly.point(child, of.at),
          value * assembly.vector(along.end == 0 ? parent : child, along.axis),
          part_at(PartKind::joint, joint)};
}

Vec3 reaction_place(const Assembly& assembly, std::size_t joint) {
  const Joint& of = assembly.mechanism.joints[joint];
  return assembly.point(assembly.joint_bodies[joint][1],
                        of.type == JointType::distance ? of.points[1] : of.at);
}

Vec3 bearing_place(const Assembly& assembly, std::size_t force) {
  return assembly.point(assembly.force_bodies[force][1],
                        assembly.mechanism.forces[force].at.value_or(Vec3::Zero()));
}

std::optional<Quat> common_turn(const Mechanism& mechanism, const Solution& solution,
                                std::span<const Pose> poses) {
  constexpr double alike = 1e-9;
  if (poses.empty() || poses.size() != solution.poses.size()) return std::nullopt;
  if (std::ranges::any_of(solution.reactions, &Reaction::varying) ||
      std::ranges::any_of(solution.bearings, &BearingForce::varying))
    return std::nullopt;
  const Quat turn = poses[0].rotation * solution.poses[0].rotation.conjugate();
  for (std::size_t b = 1; b < poses.size(); ++b)
    if (turn.angularDistance(poses[b].rotation * solution.poses[b].rotation.conjugate()) > alike)
      return std::nullopt;
  if ((turn * mechanism.gravity - mechanism.gravity).norm() > alike * mechanism.gravity.norm())
    return std::nullopt;
  return turn;
}

std::vector<Load> loads_of(const Assembly& assembly, const Solution& solution,
                           std::span<const AngularMotion> turning, int body, const Quat& turn) {
  Collector collector(assembly, solution, turning, body, turn);
  collector.reactions();
  collector.bearings();
  if (body < 0) { // of a body they are part of the reactions
    collector.drives();
    collector.joint_springs();
  }
  collector.springs();
  if (body >= 0) {
    collector.applied(); // of the mechanism they are drawn as parts of it
    collector.weight();
  }
  collector.air();
  collector.inertia();
  return std::move(collector.loads);
}

} // namespace flyball
