#include "engine/report/measures.hpp"

#include "engine/report/report_forces.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

std::size_t slot(int i) {
  return static_cast<std::size_t>(i);
}

bool asks_for_forces(Result result) {
  switch (result) {
  case Result::reaction_x:
  case Result::reaction_y:
  case Result::reaction_z:
  case Result::reaction:
  case Result::moment_x:
  case Result::moment_y:
  case Result::moment_z:
  case Result::moment:
  case Result::torque:
  case Result::power: return true;
  default: return false;
  }
}

bool asks_for_acceleration(Result result) {
  return result == Result::ax || result == Result::ay || result == Result::az ||
         result == Result::acceleration;
}

// A point of a body, or of the ground, from the link's origin.
TrackedPoint tracked(const System& system, const Parameters& p, int body, const Vec3& drawn) {
  if (body < 0) return {-1, drawn - p.origin};
  const int link = system.body_link[slot(body)];
  return {link, drawn - p.origin - p.links[slot(link)].origin};
}

Vec3 drawn_place(const Mechanism& m, const ResultQuantity::Of& of) {
  return of.point >= 0 ? m.points[slot(of.point)].at : m.bodies[slot(of.part)].position;
}

Vec3 position(const Kinematics<double>& k, const TrackedPoint& point) {
  return k.point(point.link, point.at);
}

PointMotion motion_of(const MeasuredState& s, const TrackedPoint& point) {
  return point_motion(s.parameters, s.kinematics, point);
}

double angle_between(const Vec3& a, const Vec3& b) {
  if (a.squaredNorm() == 0 || b.squaredNorm() == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double component(const Vec3& v, Result result, Result first) {
  return v[static_cast<int>(result) - static_cast<int>(first)];
}

} // namespace

void MeasureSet::bind(const Mechanism& m, const System& system, const Parameters& p) {
  if (!plan_.fits(m)) {
    plan_ = MeasurePlan(m);
    find_places(m, system);
  }
  if (empty()) return;
  plan_.set_numbers(m);
  solids_.clear();
  differenced_ = false;
  const auto add_solids = [&](int body) {
    for (const Shape& shape : m.bodies[slot(body)].shapes) {
      const bool rod = shape.type == ShapeType::capsule;
      const Vec3 centre = shape.at.value_or(m.bodies[slot(body)].position);
      solids_.push_back({tracked(system, p, body, rod ? shape.from : centre),
                         tracked(system, p, body, rod ? shape.to : centre), shape.radius});
    }
  };
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const ResultQuantity& quantity = plan_.quantities()[i];
    Place& place = places_[i];
    const ArgumentKind kind =
        argument_kind(result_function(quantity.result), static_cast<std::size_t>(quantity.count));
    if (kind == ArgumentKind::point)
      for (std::size_t n = 0; n < slot(quantity.count); ++n)
        place.points[n] = tracked(system, p, quantity.of[n].part, drawn_place(m, quantity.of[n]));
    if (kind == ArgumentKind::coordinate) {
      const Coordinate& c = m.joints[slot(quantity.of[0].part)].coordinates[slot(quantity.of[0].coordinate)];
      if (c.spring) {
        place.stiffness = c.spring->stiffness;
        place.free = c.spring->free;
      }
      place.lower = c.stop ? c.stop->lower : std::nullopt;
      place.upper = c.stop ? c.stop->upper : std::nullopt;
    }
    if (place.between_bodies) {
      place.first_solid = solids_.size();
      add_solids(quantity.of[0].part);
      place.second_solid = solids_.size();
      add_solids(quantity.of[1].part);
      place.last_solid = solids_.size();
    }
    if (quantity.result == Result::mass) {
      place.mass = 0;
      for (std::size_t b = 0; b < m.bodies.size(); ++b)
        if (quantity.count == 0 || slot(quantity.of[0].part) == b) place.mass += m.bodies[b].mass;
    }
    if (quantity.result == Result::tension)
      place.differenced = !system.torques.empty() || p.springs[slot(place.spring)].damping != 0;
    differenced_ = differenced_ || place.differenced;
  }
}

void MeasureSet::find_places(const Mechanism& m, const System& system) {
  names_.clear();
  units_.clear();
  for (const NamedMeasure& measure : m.measures) {
    names_.push_back(measure.name);
    units_.push_back(measure.unit);
  }
  const std::size_t count = plan_.quantities().size();
  places_.assign(count, {});
  found_.resize(count);
  duals_.resize(count);
  combined_.resize(plan_.size());
  values_.resize(static_cast<Eigen::Index>(plan_.size()));
  needs_forces_ = needs_accelerations_ = false;
  for (std::size_t i = 0; i < count; ++i) {
    const ResultQuantity& quantity = plan_.quantities()[i];
    const auto [part, coordinate, point] = quantity.of[0];
    Place& place = places_[i];
    const bool forces = asks_for_forces(quantity.result);
    needs_forces_ = needs_forces_ || forces;
    needs_accelerations_ = needs_accelerations_ || asks_for_acceleration(quantity.result);
    place.differenced = forces || !system.torques.empty(); // which change with the speeds found, too
    const ArgumentKind kind = argument_kind(result_function(quantity.result), slot(quantity.count));
    place.between_bodies = quantity.result == Result::clearance && kind == ArgumentKind::body;
    switch (kind) {
    case ArgumentKind::coordinate:
      for (std::size_t r = 0; r < system.reported.size(); ++r)
        if (system.reported[r].joint == m.joints[slot(part)].name && system.reported[r].index == coordinate)
          place.reported = static_cast<int>(r);
      if (quantity.result == Result::rate && system.reported[slot(place.reported)].cut >= 0)
        place.differenced = true;
      for (std::size_t d = 0; d < system.drives.size(); ++d) {
        const Link& link = system.links[slot(system.drives[d].link)];
        if (system.drives[d].motor == static_cast<int>(d) && link.coordinate == coordinate &&
            system.tree_joints[slot(link.tree_joint)].joint == part)
          place.drive = static_cast<int>(d);
      }
      break;
    case ArgumentKind::joint:
      for (std::size_t t = 0; t < system.tree_joints.size(); ++t)
        if (system.tree_joints[t].joint == part) place.tree = static_cast<int>(t);
      for (std::size_t c = 0; c < system.cuts.size(); ++c)
        if (system.cuts[c].joint == part) place.cut = static_cast<int>(c);
      break;
    case ArgumentKind::force:
      for (std::size_t f = 0; f < system.springs.size(); ++f)
        if (system.springs[f].force == part) place.spring = static_cast<int>(f);
      break;
    case ArgumentKind::body:
    case ArgumentKind::point: break;
    }
  }
}

double MeasuredState::coordinate(int listed) const {
  if (!coordinates.empty()) return coordinates[slot(listed)];
  const ReportedCoordinate& r = system.reported[slot(listed)];
  if (r.cut >= 0)
    return joint_coordinates(system.cuts[slot(r.cut)], parameters.cuts[slot(r.cut)], kinematics)
        .value[slot(r.index)];
  const CoordinateInfo& c = system.coordinates[slot(r.coordinate)];
  const double value = coordinate_value(system, parameters, q, c);
  return turns_freely(system, parameters, c.link) ? wrapped_angle(value) : value;
}

double MeasuredState::rate(int listed) const {
  if (!rates.empty()) return rates[slot(listed)];
  const ReportedCoordinate& r = system.reported[slot(listed)];
  if (r.cut >= 0) {
    const CutJoint& cut = system.cuts[slot(r.cut)];
    const CutParameters& numbers = parameters.cuts[slot(r.cut)];
    return joint_coordinates(cut, numbers, kinematics).rate.row(r.index) *
           relative_velocity(cut, numbers, kinematics);
  }
  const auto link = slot(system.coordinates[slot(r.coordinate)].link);
  if (finds_speed(system.links[link])) return q[system.links[link].q];
  return system.links[link].drive >= 0 ? parameters.links[link].speed * parameters.speed_scale : 0;
}

double MeasureSet::Place::below(double q) const {
  return lower ? q - *lower : std::numeric_limits<double>::infinity();
}
double MeasureSet::Place::above(double q) const {
  return upper ? *upper - q : std::numeric_limits<double>::infinity();
}

Clearance MeasureSet::solid_clearance(const MeasuredState& s, const Place& place) const {
  const std::span solids(solids_);
  return find_clearance(s.kinematics,
                        solids.subspan(place.first_solid, place.second_solid - place.first_solid),
                        solids.subspan(place.second_solid, place.last_solid - place.second_solid));
}

double MeasureSet::value(const MeasuredState& s, std::size_t i) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const Place& place = places_[i];
  const auto motion = [&] { return motion_of(s, place.points[0]); };
  const auto joint = [&]() -> const JointWrench& {
    return place.tree >= 0 ? s.forces->tree[slot(place.tree)] : s.forces->cuts[slot(place.cut)];
  };
  const auto spring = [&] {
    return spring_state(s.system.springs[slot(place.spring)], s.parameters.springs[slot(place.spring)],
                        s.kinematics);
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  switch (quantity.result) {
  case Result::coordinate: return s.coordinate(place.reported);
  case Result::rate: return s.rate(place.reported);
  case Result::x:
  case Result::y:
  case Result::z: return component(motion().position, quantity.result, Result::x);
  case Result::vx:
  case Result::vy:
  case Result::vz: return component(motion().velocity, quantity.result, Result::vx);
  case Result::ax:
  case Result::ay:
  case Result::az:
    return s.accelerated ? component(motion().acceleration, quantity.result, Result::ax) : none;
  case Result::speed: return motion().velocity.norm();
  case Result::acceleration: return s.accelerated ? motion().acceleration.norm() : none;
  case Result::distance:
    return (position(s.kinematics, place.points[1]) - position(s.kinematics, place.points[0])).norm();
  case Result::angle: {
    const Vec3 corner = position(s.kinematics, place.points[1]);
    return angle_between(position(s.kinematics, place.points[0]) - corner,
                         position(s.kinematics, place.points[2]) - corner);
  }
  case Result::length: return spring().length;
  case Result::tension: return spring().tension;
  case Result::spring: return -place.stiffness * (s.coordinate(place.reported) - place.free);
  case Result::reaction_x:
  case Result::reaction_y:
  case Result::reaction_z: return component(joint().force, quantity.result, Result::reaction_x);
  case Result::reaction: return joint().force.norm();
  case Result::moment_x:
  case Result::moment_y:
  case Result::moment_z: return component(joint().torque, quantity.result, Result::moment_x);
  case Result::moment: return joint().torque.norm();
  case Result::torque: return place.drive < 0 ? none : s.forces->drives[slot(place.drive)];
  case Result::power:
    return place.drive < 0 ? none : s.forces->drives[slot(place.drive)] * s.rate(place.reported);
  case Result::clearance: {
    if (place.between_bodies) return solid_clearance(s, place).gap;
    const double q = s.coordinate(place.reported);
    return std::min(place.below(q), place.above(q));
  }
  case Result::mass: break;
  }
  return place.mass;
}

void MeasureSet::evaluate_quantities(const MeasuredState& state) {
  for (std::size_t i = 0; i < places_.size(); ++i)
    found_[i] = value(state, i);
}

const Eigen::VectorXd& MeasureSet::combine() {
  for (std::size_t i = 0; i < found_.size(); ++i)
    duals_[i] = {found_[i], 0};
  plan_.evaluate(duals_, combined_);
  for (std::size_t i = 0; i < combined_.size(); ++i)
    values_[static_cast<Eigen::Index>(i)] = combined_[i].value;
  return values_;
}

const Eigen::VectorXd& MeasureSet::evaluate(const MeasuredState& state) {
  evaluate_quantities(state);
  return combine();
}

const Eigen::VectorXd& MeasureSet::evaluate(const Problem& problem, const Unknowns& z, const Workspace& w) {
  TransmittedForces forces;
  if (needs_forces_) {
    forces = transmitted_forces(problem.system, problem.parameters, z.lambda, w.kinematics, w.residual);
    largest_force_ = 0;
    for (const auto* list : {&forces.tree, &forces.cuts})
      for (const JointWrench& each : *list)
        largest_force_ =
            std::max({largest_force_, each.force.norm(), each.torque.norm() / problem.parameters.length});
  }
  return evaluate({problem.system, problem.parameters, z.q, w.kinematics, &forces});
}

const Eigen::VectorXd& MeasureSet::evaluate_at(const Problem& problem, const Eigen::VectorXd& q,
                                               Workspace& w) {
  if (needs_forces_) return evaluate(problem, with_reported_multipliers(problem, q, 0, w), w);
  forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
  return evaluate({problem.system, problem.parameters, q, w.kinematics});
}

double MeasureSet::rounding_size(const MeasuredState& s, std::size_t i) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const double reach = s.parameters.length, size = std::abs(found_[i]);
  switch (quantity.result) {
  case Result::vx:
  case Result::vy:
  case Result::vz: return motion_of(s, places_[i].points[0]).velocity.norm();
  case Result::ax:
  case Result::ay:
  case Result::az: return motion_of(s, places_[i].points[0]).acceleration.norm();
  case Result::reaction_x:
  case Result::reaction_y:
  case Result::reaction_z:
  case Result::reaction: return largest_force_;
  case Result::moment_x:
  case Result::moment_y:
  case Result::moment_z:
  case Result::moment: return largest_force_ * reach;
  case Result::torque: return largest_force_ * (quantity.angle ? reach : 1);
  case Result::power:
    return largest_force_ * (quantity.angle ? reach : 1) * std::abs(s.rate(places_[i].reported));
  case Result::mass:
  case Result::rate:
  case Result::angle: return size;
  case Result::coordinate: return std::max(size, quantity.angle ? 1 : reach);
  case Result::spring: return std::abs(places_[i].stiffness) * std::max(size, quantity.angle ? 1 : reach);
  case Result::tension:
    return std::max(size, s.parameters.springs[slot(places_[i].spring)].stiffness * reach);
  default: return size + reach;
  }
}

std::vector<MeasureSolution> MeasureSet::solutions(const Problem& problem, const Unknowns& z,
                                                   const Eigen::VectorXd& error, Workspace& w) {
  std::vector<MeasureSolution> out(size());
  if (empty()) return out;
  evaluate(problem, z, w);
  for (std::size_t i = 0; i < size(); ++i) {
    out[i].name = names_[i];
    out[i].unit = units_[i];
    const double value = values_[static_cast<Eigen::Index>(i)];
    if (std::isfinite(value))
      out[i].value = value;
    else
      out[i].reason = "Its value is not finite here.";
  }
  if (error.size() != problem.system.nv) return out;
  gradient(problem, z.q, w, w.elsewhere());
  // Beside the coordinates' errors what rounds: positions by the mechanism's reach, all else by its own size.
  const double epsilon = std::numeric_limits<double>::epsilon();
  const MeasuredState state{problem.system, problem.parameters, z.q, w.kinematics};
  for (std::size_t i = 0; i < size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double estimate = rates_.row(row).cwiseAbs() * error;
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const double part = std::abs(partials_(row, static_cast<Eigen::Index>(k)));
      if (part > 0) estimate += 16 * epsilon * part * rounding_size(state, k);
    }
    if (out[i].value && std::isfinite(estimate)) out[i].error = estimate + epsilon * std::abs(*out[i].value);
  }
  return out;
}

void MeasureSet::mark_nonunique(const Mechanism& m, const std::vector<Reaction>& reactions,
                                const std::vector<DriveTorque>& torques,
                                std::vector<MeasureSolution>& out) const {
  if (!needs_forces_) return;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const ResultQuantity& quantity = plan_.quantities()[k];
    if (!asks_for_forces(quantity.result)) continue;
    const std::string& joint = m.joints[slot(quantity.of[0].part)].name;
    const bool drive = quantity.result == Result::torque || quantity.result == Result::power;
    const bool shared = drive ? std::ranges::any_of(torques,
                                                    [&](const DriveTorque& t) {
                                                      return t.nonunique && t.joint == joint &&
                                                             t.index == quantity.of[0].coordinate;
                                                    })
                              : std::ranges::any_of(reactions, [&](const Reaction& r) {
                                  return r.nonunique && r.joint == joint;
                                });
    if (!shared) continue;
    const std::vector<bool> users = plan_.users_of(k);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i].nonunique = out[i].nonunique || users[i];
  }
}

} // namespace flyball
