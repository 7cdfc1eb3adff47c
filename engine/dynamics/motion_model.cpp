#include "engine/dynamics/motion_model.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/system/law_phase.hpp"
#include "engine/system/motion.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>

namespace flyball {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

const TreeJoint& joint_of(const System& system, const CoordinateInfo& c) {
  return system.tree_joints[at(c.tree_joint)];
}

bool is_called(const System& system, const CoordinateInfo& c, std::string_view name) {
  const TreeJoint& joint = joint_of(system, c);
  return name == joint.name + "." + std::to_string(c.index) ||
         (coordinate_count(joint.type) == 1 && name == joint.name);
}

// Free coordinates up to which dense matrices are the faster ones: in a chain an evaluation takes 2.2 against
// 2.4 us with 8 coordinates, 6.9 against 6.0 with 20, and 41 against 14 with 60.
constexpr int few = 16;
// And those up to which they are beside the sparse equations: in two chains of hinges tied by rods an
// evaluation takes 0.24 against 0.72 ms with 80 coordinates, in a net of springs 0.48 against 0.09 with 216.
constexpr int few_of_bodies = 140;

// Whose equations can be solved along it: see TreeMotion.
bool is_tree(const System& system) {
  return system.rows == 0 && (!has_pairs(system) || no_drive_rides(system));
}

} // namespace

bool has_pairs(const System& system) {
  return !system.springs.empty() || !system.cut_dampers.empty() || !system.bearings.empty() ||
         !system.turning_air.empty();
}

void bind_motion(const System& system, const Mechanism& mechanism, Parameters& out) {
  bind(system, mechanism, out);
  out.moving = true; // whether drives turn or not
}

MotionModel make_motion_model(const Mechanism& mechanism, bool damped) {
  MotionModel m;
  m.mechanism = mechanism;
  const System steady = compile_for_drives(mechanism);
  m.system = compile_for_motion(mechanism, steady);
  m.finds_speeds = !steady.torques.empty();
  if (asks_for_points(steady)) { // only what turns steadily tells that they do not
    Parameters as_steady;
    bind(steady, mechanism, as_steady);
  }
  m.released = released(m.system);
  bind_motion(m.system, mechanism, m.parameters);
  set_scaling(m.system, m.parameters, m.scaling);
  const bool dense = !m.system.torques.empty() || !m.system.bearings.empty() ||
                     !m.system.turning_air.empty(); // the matrices alone know
  m.along_tree = is_tree(m.system) && m.system.nv > few && !dense;
  m.sparse = no_drive_rides(m.system) && m.system.nv > few_of_bodies && !dense;
  if (damped) return m;
  for (LinkParameters& l : m.parameters.links)
    for (CoordinateForce& f : l.force)
      f.remove_damper();
  for (PointSpringParameters& s : m.parameters.springs)
    s.remove_damper();
  for (BearingParameters& b : m.parameters.bearings)
    b.damping.setZero();
  for (CutDamperParameters& d : m.parameters.cut_dampers)
    d.remove_damper();
  return m;
}

int coordinate_called(const System& system, std::string_view name) {
  const auto c = std::ranges::find_if(system.coordinates,
                                      [&](const CoordinateInfo& x) { return is_called(system, x, name); });
  return c == system.coordinates.end() ? -1 : static_cast<int>(c - system.coordinates.begin());
}

std::string name_of_coordinate(const MotionModel& model, int v) {
  for (const CoordinateInfo& c : model.released.coordinates) {
    const Link& link = model.released.links[at(c.link)];
    const int own = link.type == LinkType::spherical ? link.v + c.index - link.coordinate : link.v;
    if (own != v) continue;
    const TreeJoint& joint = joint_of(model.released, c);
    return coordinate_count(joint.type) == 1 ? joint.name : joint.name + "." + std::to_string(c.index);
  }
  return "";
}

SimulationState name_state(const MotionModel& model, double time, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& u) {
  SimulationState out;
  out.time = time;
  for (const CoordinateInfo& c : model.system.coordinates) {
    const Link& link = model.system.links[at(c.link)];
    const LinkParameters& p = model.parameters.links[at(c.link)];
    StateCoordinate x;
    x.joint = joint_of(model.system, c).name;
    x.index = c.index;
    if (link.drive >= 0) {
      x.value = p.drawn + (p.start + p.speed * time);
      x.rate = p.speed;
    } else if (link.type == LinkType::spherical) {
      const int k = c.index - link.coordinate;
      x.value = rotation_vector(link, p, q)[k];
      x.rate = rotation_vector_rate(link, p, q).row(k) * u.segment<3>(link.v);
    } else {
      x.value = q[link.q];
      x.rate = u[link.v];
    }
    out.coordinates.push_back(std::move(x));
  }
  return out;
}

void take_state(const SimulationState& state, MotionModel& model, Eigen::VectorXd& q, Eigen::VectorXd& u) {
  drawn_configuration(model.system, model.parameters, q);
  u.setZero(model.system.nv);
  const auto value_of = [&](const std::string& joint, int index) -> const StateCoordinate& {
    const auto x = std::ranges::find_if(
        state.coordinates, [&](const StateCoordinate& s) { return s.joint == joint && s.index == index; });
    if (x == state.coordinates.end())
      throw SceneError("joints." + joint, "is not in the saved state; it belongs to another mechanism");
    return *x;
  };
  for (const CoordinateInfo& c : model.system.coordinates) {
    const Link& link = model.system.links[at(c.link)];
    LinkParameters& p = model.parameters.links[at(c.link)];
    const std::string& joint = joint_of(model.system, c).name;
    const StateCoordinate& x = value_of(joint, c.index);
    if (link.drive >= 0) { // the speed is the scene's; the drive goes on from where it stands
      p.start = (x.value - p.drawn) - p.speed * state.time;
    } else if (link.type == LinkType::spherical) {
      if (c.index != link.coordinate) continue;
      Vec3 r, rate;
      for (int k = 0; k < 3; ++k) {
        r[k] = value_of(joint, c.index + k).value;
        rate[k] = value_of(joint, c.index + k).rate;
      }
      set_rotation_vector(link, p, r, q);
      u.segment<3>(link.v) = rotation_vector_rate(link, p, q).partialPivLu().solve(rate);
    } else {
      q[link.q] = x.value;
      u[link.v] = x.rate;
    }
  }
}

} // namespace flyball
