#include "engine/dynamics/recorder.hpp"

#include "engine/mechanism/damped.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/potential.hpp"
#include "engine/system/reactions.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

namespace flyball {
namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

} // namespace

void Recorder::use(std::shared_ptr<const MotionModel> model, Equations& equations) {
  model_ = std::move(model);
  equations_ = &equations;
  run_.segments.push_back({run_.time.size(), model_});
  jacobi_ = has_jacobi() && (run_.time.empty() || !run_.energy.jacobi.empty());
  if (!jacobi_) run_.energy.jacobi.clear();
  if (run_.coordinates.empty() && run_.drives.empty()) lay_out();
  tree_joints_.clear();
  for (std::size_t i = 0; reactions_ && i < model_->system.tree_joints.size(); ++i)
    tree_joints_.emplace(model_->system.tree_joints[i].name, i);
  if (reactions_) find_springs();
  tracked_.clear();
  for (const BodyPoint& point : points_)
    tracked_.push_back(find_point(model_->system, model_->mechanism, model_->parameters, point));
  if (measured_) measures_.bind(model_->mechanism, model_->system, model_->parameters);
}

void Recorder::follow(std::shared_ptr<const MotionModel> model, Equations& equations) {
  model_ = std::move(model);
  equations_ = &equations;
  if (measured_) measures_.bind(model_->mechanism, model_->system, model_->parameters);
}

void Recorder::lay_out() {
  const System& system = model_->system;
  for (const ReportedCoordinate& r : system.reported) {
    CoordinateTrack track;
    track.joint = r.joint;
    track.index = r.index;
    track.count = r.count;
    track.angle = r.angle;
    track.scale = r.angle ? 1 : model_->parameters.length;
    if (r.cut >= 0) {
      const JointType type = system.cuts[index(r.cut)].type;
      track.dependent = true;
      track.rotation = is_rotation_vector(type, r.index);
      track.turns = r.angle && !track.rotation;
    } else {
      const CoordinateInfo& c = system.coordinates[index(r.coordinate)];
      const Link& link = system.links[index(c.link)];
      track.driven = link.drive >= 0;
      track.rotation = link.type == LinkType::spherical;
      track.turns = turns_freely(system, model_->parameters, c.link);
    }
    run_.coordinates.push_back(std::move(track));
  }
  for (std::size_t d = 0; d < system.drives.size(); ++d) {
    if (system.drives[d].motor != static_cast<int>(d)) continue;
    const Link& link = system.links[index(system.drives[d].link)];
    const TreeJoint& joint = system.tree_joints[index(link.tree_joint)];
    run_.drives.push_back(
        {joint.name, link.coordinate, coordinate_count(joint.type), link.type == LinkType::revolute, {}, {}});
  }
  for (const DriveTorqueElement& drive : system.torques) {
    const Link& link = system.links[index(drive.link)];
    const TreeJoint& joint = system.tree_joints[index(link.tree_joint)];
    run_.drives.push_back(
        {joint.name, link.coordinate, coordinate_count(joint.type), link.type == LinkType::revolute, {}, {}});
  }
  for (const BodyPoint& point : points_)
    run_.points.push_back({point, {}, {}, {}});
  if (measured_)
    for (const NamedMeasure& measure : model_->mechanism.measures)
      run_.measures.push_back({measure.name, measure.unit, {}});
  if (!reactions_) return;
  const Mechanism& mechanism = model_->mechanism;
  for (const Joint& j : mechanism.joints) {
    if (j.type != JointType::gear) {
      run_.reactions.push_back({j.name, {}, {}});
      continue;
    }
    const auto angle = [&](std::size_t end) {
      const CoordinateReference of = find_coordinate(mechanism, j.joints[end]);
      return is_angle(mechanism.joints[index(of.joint)].type, of.coordinate);
    };
    run_.gears.push_back({j.name, angle(0), angle(1), {}, {}});
  }
  for (const BearingElement& bearing : system.bearings)
    run_.bearings.push_back({mechanism.forces[index(bearing.force)].name, {}, {}});
}

void Recorder::find_springs() {
  const System& system = model_->system;
  const Mechanism& m = model_->mechanism;
  const bool first = run_.time.empty();
  sprung_.clear();
  for (std::size_t i = 0; i < system.reported.size(); ++i) {
    const ReportedCoordinate& r = system.reported[i];
    const int j = r.cut >= 0
                      ? system.cuts[index(r.cut)].joint
                      : system.tree_joints[index(system.coordinates[index(r.coordinate)].tree_joint)].joint;
    if (j < 0 || is_rotation_vector(m.joints[index(j)].type, r.index)) continue;
    const Coordinate& c = m.joints[index(j)].coordinates[index(r.index)];
    if (!c.spring && !is_damped(c) && !c.stop) continue;
    SpringPlace place{static_cast<int>(i), -1, -1};
    for (std::size_t d = 0; r.cut >= 0 && d < system.cut_dampers.size(); ++d)
      if (system.cut_dampers[d].joint == j && system.cut_dampers[d].coordinate == r.index)
        place.cut_damper = static_cast<int>(d);
    sprung_.push_back(place);
    if (first) run_.springs.push_back({r.joint, r.index, r.count, false, r.angle, {}, {}, {}});
  }
  for (std::size_t s = 0; s < system.springs.size(); ++s) {
    sprung_.push_back({-1, -1, static_cast<int>(s)});
    if (first)
      run_.springs.push_back({m.forces[index(system.springs[s].force)].name, 0, 1, true, false, {}, {}, {}});
  }
  if (sprung_.size() == run_.springs.size()) return;
  sprung_.clear(); // others than those that were recorded so far
  run_.springs.clear();
}

void Recorder::name(const StopElement& stop, StopEvent& event) const {
  const Link& link = model_->system.links[index(stop.link)];
  event.joint = model_->system.tree_joints[index(link.tree_joint)].name;
  event.index = link.coordinate + stop.component;
}

void Recorder::name(const FrictionElement& friction, FrictionEvent& event) const {
  const Link& link = model_->system.links[index(friction.link)];
  event.joint = model_->system.tree_joints[index(link.tree_joint)].name;
  event.index = link.coordinate;
}

void Recorder::record_coordinates(double t) {
  const System& system = model_->system;
  const Eigen::VectorXd& q = equations_->configuration();
  const Eigen::VectorXd& u = equations_->velocity();
  int measured = -1;
  JointCoordinates joint;
  RelativeVelocity velocity;
  for (std::size_t i = 0; i < system.reported.size(); ++i) {
    const ReportedCoordinate& r = system.reported[i];
    CoordinateTrack& track = run_.coordinates[i];
    if (r.cut >= 0) {
      if (measured != r.cut) {
        const CutParameters& numbers = model_->parameters.cuts[index(r.cut)];
        joint = joint_coordinates(system.cuts[index(r.cut)], numbers, equations_->kinematics());
        velocity = relative_velocity(system.cuts[index(r.cut)], numbers, equations_->kinematics());
        measured = r.cut;
      }
      const double rate = joint.rate.row(r.index) * velocity;
      track.value.push_back(go_on_from(track, joint.value[index(r.index)], rate));
      track.rate.push_back(rate);
      continue;
    }
    const CoordinateInfo& c = system.coordinates[index(r.coordinate)];
    const Link& link = system.links[index(c.link)];
    const LinkParameters& p = model_->parameters.links[index(c.link)];
    if (link.drive >= 0) {
      track.value.push_back(p.drawn + (p.start + p.speed * t));
      track.rate.push_back(p.speed);
    } else if (link.type == LinkType::spherical) {
      const int k = c.index - link.coordinate;
      track.value.push_back(rotation_vector(link, p, q)[k]);
      track.rate.push_back(rotation_vector_rate(link, p, q).row(k) * u.segment<3>(link.v));
    } else {
      track.value.push_back(q[link.q]);
      track.rate.push_back(u[link.v]);
    }
  }
}

// An angle that is measured goes on beyond a turn: with the whole turns that the rates foretell.
double Recorder::go_on_from(const CoordinateTrack& track, double value, double rate) const {
  if (!track.turns || track.value.empty()) return value;
  const double span = run_.time.back() - run_.time[run_.time.size() - 2];
  const double foretold = track.value.back() + (track.rate.back() + rate) / 2 * span;
  return foretold + std::remainder(value - foretold, 2 * std::numbers::pi);
}

// T_2 + U: the kinetic energy of the same motion with the drives at rest, and U = V - T_0 the amended
// potential.
double Recorder::jacobi(double t) {
  const System& system = model_->system;
  const Eigen::VectorXd& all_q = equations_->configuration();
  const Eigen::VectorXd q = all_q.head(system.nq);
  Eigen::VectorXd u = equations_->velocity();
  u.tail(u.size() - system.nv).setZero();
  std::vector<LinkRates> none;
  move(model_->released, model_->parameters, {all_q, u}, standing_, none);
  const double kinetic = kinetic_energy(model_->released, model_->parameters, standing_);
  forward<double>(system, model_->parameters, q, t, standing_);
  return kinetic + amended_potential(system, model_->parameters, q, standing_).value;
}

// Whether the Lagrangian is the same at every phase of the drives: by the shape of the mechanism, or as far
// as a displaced state tells at a few phases.
bool Recorder::has_jacobi() {
  const System& system = model_->system;
  const Parameters& p = model_->parameters;
  for (const BodyForceElement& e : system.body_forces) {
    const Force& f = model_->mechanism.forces[index(e.force)];
    if (e.link >= 0 && (f.type != ForceType::force || f.frame != ForceFrame::world)) return false;
  }
  // What is not symmetric in a bearing's stiffness has no potential.
  if (std::ranges::any_of(p.bearings,
                          [](const BearingParameters& b) { return b.stiffness != b.stiffness.transpose(); }))
    return false;
  if (!system.turning_air.empty() || !system.torques.empty() || !list_frictions(*model_).empty())
    return false;
  if (system.drives.empty() || p.phase_free) return true;
  Eigen::VectorXd q, all_q(model_->released.nq), all_u(model_->released.nv), step(system.nv);
  drawn_configuration(system, p, q);
  for (int v = 0; v < system.nv; ++v) {
    step[v] = 0.3 * std::sin(2.1 * v + 1) * model_->scaling.column[v];
    all_u[v] = std::cos(1.3 * v + 2) * model_->scaling.column[v];
  }
  retract<double>(system, step, q);
  const Eigen::VectorXd u = all_u.head(system.nv);
  Kinematics<double> moving;
  std::vector<LinkRates> none;
  const std::vector<DriveRate> rates = drive_rates(system, p);
  std::vector<double> times = phase_times(rates);
  times.insert(times.begin(), 0);
  std::optional<double> first;
  double size = 0;
  for (const double t : times) {
    all_q.head(system.nq) = q;
    set_drives(system, p, t, all_q, all_u);
    move(model_->released, p, {all_q, all_u}, moving, none);
    const double kinetic = kinetic_energy(system, p, moving);
    forward<double>(system, p, q, t, standing_);
    // T_0 of bodies that only drives move differs from phase to phase with nothing that depends on q_R.
    const double lagrangian =
        kinetic - kinetic_energy(system, p, standing_) - amended_potential(system, p, q, standing_).value;
    if (!first) first = lagrangian;
    size = std::max(size, kinetic + std::abs(*first));
    if (std::abs(lagrangian - *first) > (1e-10 + 4 * angle_rounding(rates, t)) * size) return false;
  }
  return true;
}

void Recorder::record_energies(double t, const Eigen::Vector3d& energies) {
  EnergyTracks& e = run_.energy;
  const double stored = equations_->stored_energy();
  const double kinetic = kinetic_energy(model_->released, model_->parameters, equations_->kinematics());
  if (run_.time.size() == 1) base_ = stored;
  e.kinetic.push_back(kinetic);
  e.potential.push_back(stored - kinetic);
  e.dissipated.push_back(energies[0]);
  e.delivered.push_back(energies[1]);
  e.applied.push_back(energies[2]);
  e.balance.push_back((stored - base_) + energies[0] - energies[1] - energies[2]);
  if (jacobi_) e.jacobi.push_back(jacobi(t));
}

void Recorder::go_on() {
  base_ = equations_->stored_energy() + run_.energy.dissipated.back() - run_.energy.delivered.back() -
          run_.energy.applied.back() - run_.energy.balance.back();
}

Eigen::Vector3d Recorder::energies() const {
  return {run_.energy.dissipated.back(), run_.energy.delivered.back(), run_.energy.applied.back()};
}

void Recorder::record_reactions(const TransmittedForces& forces) {
  const System& system = model_->system;
  for (ReactionTrack& track : run_.reactions) {
    const auto push = [&](const JointWrench& w) {
      track.force.push_back(w.force);
      track.torque.push_back(w.torque);
    };
    if (const auto tree = tree_joints_.find(track.joint); tree != tree_joints_.end()) {
      push(forces.tree[tree->second]);
      continue;
    }
    for (std::size_t c = 0; c < system.cuts.size(); ++c)
      if (model_->mechanism.joints[index(system.cuts[c].joint)].name == track.joint) push(forces.cuts[c]);
  }
}

// Of bearings and gears.
void Recorder::record_elements(const TransmittedForces& forces) {
  const System& system = model_->system;
  for (std::size_t i = 0; i < run_.bearings.size(); ++i) {
    run_.bearings[i].force.push_back(forces.bearings[i].force);
    run_.bearings[i].torque.push_back(forces.bearings[i].torque);
  }
  for (GearTrack& track : run_.gears) {
    const auto of = std::ranges::find_if(forces.gears, [&](const GearForces& g) {
      return model_->mechanism.joints[index(g.joint)].name == track.joint;
    });
    constexpr double without = std::numeric_limits<double>::quiet_NaN();
    const bool loaded = of != forces.gears.end() && of->a.link >= 0;
    const GearEnds ends = loaded ? ends_in_order(model_->mechanism, system, *of) : GearEnds{};
    track.a.push_back(loaded ? ends.a.value : without);
    track.b.push_back(loaded ? ends.b.value : without);
  }
}

void Recorder::record_springs() {
  const System& system = model_->system;
  const Parameters& p = model_->parameters;
  const Kinematics<double>& k = equations_->kinematics();
  for (std::size_t i = 0; i < sprung_.size(); ++i) {
    const SpringPlace& place = sprung_[i];
    double spring = 0, damper = 0, stop = 0;
    if (place.spring >= 0) {
      const PointSpringElement& e = system.springs[index(place.spring)];
      const PointSpringParameters& numbers = p.springs[index(place.spring)];
      const SpringState<double> s = spring_state(e, numbers, k);
      spring = numbers.pull(s.length);
      damper = s.tension - spring;
    } else if (const ReportedCoordinate& r = system.reported[index(place.coordinate)]; r.coordinate >= 0) {
      const CoordinateInfo& c = system.coordinates[index(r.coordinate)];
      const CoordinateForce& force =
          p.links[index(c.link)].force[index(c.index - system.links[index(c.link)].coordinate)];
      const double q = run_.coordinates[index(place.coordinate)].value.back();
      spring = -force.stiffness * (q - force.free);
      if (force.laws) spring -= force.laws->spring.value(q - force.laws->free);
      damper = -force.resistance(run_.coordinates[index(place.coordinate)].rate.back());
      if (force.has_lower && q < force.lower) stop = -force.stop_stiffness * (q - force.lower);
      if (force.has_upper && q > force.upper) stop = -force.stop_stiffness * (q - force.upper);
    } else if (place.cut_damper >= 0) {
      damper = -cut_damper_state<double>(system.cut_dampers[index(place.cut_damper)],
                                         p.cut_dampers[index(place.cut_damper)], k)
                    .resistance;
    }
    SpringTrack& track = run_.springs[i];
    track.spring.push_back(spring);
    track.damper.push_back(damper);
    track.stop.push_back(stop);
  }
}

void Recorder::record_measures(TransmittedForces& forces) {
  values_.clear();
  rates_.clear();
  for (const CoordinateTrack& track : run_.coordinates) {
    values_.push_back(track.value.back());
    rates_.push_back(track.rate.back());
  }
  const System& system = model_->system;
  forces.drives.assign(system.drives.size(), 0);
  std::size_t motor = 0;
  for (std::size_t d = 0; d < system.drives.size(); ++d)
    if (system.drives[d].motor == static_cast<int>(d)) forces.drives[d] = run_.drives[motor++].torque.back();
  torques_.clear();
  for (; motor < run_.drives.size(); ++motor)
    torques_.push_back(run_.drives[motor].torque.back());
  const bool accelerated = measures_.needs_accelerations() && !equations_->has_massless();
  const Kinematics<double>& kinematics =
      accelerated ? equations_->accelerated_kinematics() : equations_->kinematics();
  const Eigen::VectorXd& values =
      measures_.evaluate({system, model_->parameters, equations_->configuration(), kinematics, &forces,
                          accelerated, values_, rates_, torques_});
  for (std::size_t i = 0; i < run_.measures.size(); ++i)
    run_.measures[i].value.push_back(values[static_cast<Eigen::Index>(i)]);
}

void Recorder::record_points() {
  if (equations_->has_massless())
    for (PointTrack& track : run_.points)
      track.acceleration.clear();
  const Kinematics<double>& kinematics = equations_->accelerated_kinematics();
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    PointTrack& track = run_.points[i];
    const PointMotion now = point_motion(model_->parameters, kinematics, tracked_[i]);
    if (track.acceleration.size() == track.position.size() && !equations_->has_massless())
      track.acceleration.push_back(now.acceleration);
    track.position.push_back(now.position);
    track.velocity.push_back(now.velocity);
  }
}

void Recorder::record(double t, const Eigen::Vector3d& energies, double shift) {
  const System& system = model_->system;
  run_.time.push_back(t);
  record_coordinates(t);
  record_energies(t, energies);
  std::size_t motor = 0;
  for (std::size_t d = 0; d < system.drives.size(); ++d) {
    if (system.drives[d].motor != static_cast<int>(d)) continue;
    double torque = 0;
    for (std::size_t e = 0; e < system.drives.size(); ++e)
      if (system.drives[e].motor == static_cast<int>(d))
        torque += equations_->drive_force(static_cast<int>(e)) *
                  model_->parameters.links[index(system.drives[e].link)].gear_ratio;
    run_.drives[motor++].torque.push_back(torque);
  }
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    const DriveTorqueElement& drive = system.torques[i];
    const TorqueAndLoad now = torque_and_load(model_->released, model_->parameters, i,
                                              equations_->configuration(), equations_->kinematics());
    DriveTrack& track = run_.drives[motor++];
    track.torque.push_back(now.torque - now.load);
    if (!drive.keeps_momentum && !drive.implied) track.load.push_back(now.load);
  }
  RunStatistics& s = run_.statistics;
  s.position_drift = std::max(s.position_drift, equations_->position_drift());
  s.velocity_drift = std::max(s.velocity_drift, equations_->velocity_drift());
  s.correction = std::max(s.correction, shift);
  const Eigen::VectorXd& q = equations_->configuration();
  const Eigen::VectorXd& u = equations_->velocity();
  run_.states.insert(run_.states.end(), q.data(), q.data() + system.nq);
  run_.states.insert(run_.states.end(), u.data(), u.data() + system.nv);
  TransmittedForces forces;
  if (reactions_ || measures_.needs_forces()) forces = equations_->reactions();
  if (reactions_) {
    record_reactions(forces);
    record_elements(forces);
    record_springs();
  }
  if (!measures_.empty()) record_measures(forces);
  if (!tracked_.empty()) record_points();
}

} // namespace flyball
