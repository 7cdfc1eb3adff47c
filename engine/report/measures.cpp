#include "engine/report/measures.hpp"

#include "engine/report/report_forces.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

std::size_t slot(int i) {
  return static_cast<std::size_t>(i);
}

constexpr double huge = 1e9;           // in SI units: of a quantity whose error is not known
constexpr double unknown_error = 1e-8; // scaled, of a coordinate: then
constexpr double measure_rounding = 16 * std::numeric_limits<double>::epsilon(); // of a quantity of size 1

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

// Of a spring or bearing, in world axes.
bool is_elastic_wrench(Result result) {
  return result >= Result::force_x && result <= Result::couple;
}

bool asks_for_acceleration(Result result) {
  return result == Result::ax || result == Result::ay || result == Result::az ||
         result == Result::acceleration;
}

// Which component it is.
int slot_of(Result result, Result first) {
  return static_cast<int>(result) - static_cast<int>(first);
}

} // namespace

void MeasureSet::bind(const Mechanism& m, const System& system, const Parameters& p) {
  if (!plan_.fits(m)) {
    plan_ = MeasurePlan(m);
    find_places(m, system);
  }
  if (empty()) return;
  plan_.set_numbers(m);
  differenced_ = false;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const ResultQuantity& quantity = plan_.quantities()[i];
    Place& place = places_[i];
    take_numbers<double>(quantity, system, p, m, {}, numbers_[i]);
    if (quantity.result == Result::tension)
      place.differenced = !system.torques.empty() || p.springs[slot(place.elastic.spring)].damped();
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
  numbers_.assign(count, {});
  number_rates_.assign(count, {});
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
    // Those of speeds found change with these, too.
    place.differenced = forces || is_elastic_wrench(quantity.result) || !system.torques.empty();
    place.differenced_by_numbers = forces;
    const ArgumentKind kind = argument_kind(result_function(quantity.result), slot(quantity.count));
    switch (kind) {
    case ArgumentKind::coordinate:
      for (std::size_t r = 0; r < system.reported.size(); ++r)
        if (system.reported[r].joint == m.joints[slot(part)].name && system.reported[r].index == coordinate)
          place.reported = static_cast<int>(r);
      if (system.reported[slot(place.reported)].cut >= 0) {
        place.differenced = place.differenced || quantity.result == Result::rate;
        place.differenced_by_numbers = true;
      }
      for (std::size_t d = 0; d < system.drives.size(); ++d) {
        const Link& link = system.links[slot(system.drives[d].link)];
        if (system.drives[d].motor == static_cast<int>(d) && link.coordinate == coordinate &&
            system.tree_joints[slot(link.tree_joint)].joint == part)
          place.drive = static_cast<int>(d);
      }
      for (std::size_t t = 0; t < system.torques.size(); ++t) {
        const Link& link = system.links[slot(system.torques[t].link)];
        if (link.coordinate == coordinate && system.tree_joints[slot(link.tree_joint)].joint == part)
          place.torque = static_cast<int>(t);
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
        if (system.springs[f].force == part) place.elastic.spring = static_cast<int>(f);
      for (std::size_t f = 0; f < system.bearings.size(); ++f)
        if (system.bearings[f].force == part) place.elastic.bearing = static_cast<int>(f);
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

Clearance MeasureSet::clearance_of(const Kinematics<double>& kinematics, std::size_t i) const {
  return find_clearance(kinematics, numbers_[i].solids[0], numbers_[i].solids[1]);
}

double MeasureSet::value(const MeasuredState& s, std::size_t i) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const Place& place = places_[i];
  const QuantityNumbers& numbers = numbers_[i];
  const auto joint = [&]() -> const JointWrench& {
    return place.tree >= 0 ? s.forces->tree[slot(place.tree)] : s.forces->cuts[slot(place.cut)];
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  switch (quantity.result) {
  case Result::coordinate: return s.coordinate(place.reported);
  case Result::rate: return s.rate(place.reported);
  case Result::spring: return numbers.spring(s.coordinate(place.reported));
  case Result::clearance:
    return is_clearance_of_bodies(quantity) ? clearance_of(s.kinematics, i).gap
                                            : numbers.clearance(s.coordinate(place.reported));
  case Result::reaction_x:
  case Result::reaction_y:
  case Result::reaction_z: return joint().force[slot_of(quantity.result, Result::reaction_x)];
  case Result::reaction: return joint().force.norm();
  case Result::moment_x:
  case Result::moment_y:
  case Result::moment_z: return joint().torque[slot_of(quantity.result, Result::moment_x)];
  case Result::moment: return joint().torque.norm();
  case Result::torque: return torque(s, place);
  case Result::power: return torque(s, place) * s.rate(place.reported);
  default:
    if (!s.accelerated && asks_for_acceleration(quantity.result)) return none;
    return quantity_value(quantity, numbers, place.elastic, s.system, s.parameters, s.kinematics);
  }
}

double MeasureSet::torque(const MeasuredState& s, const Place& place) {
  if (place.drive >= 0) return s.forces->drives[slot(place.drive)];
  if (place.torque >= 0 && !s.torques.empty()) return s.torques[slot(place.torque)];
  return std::numeric_limits<double>::quiet_NaN();
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

double MeasureSet::elastic_rounding(const MeasuredState& s, const ElasticPlace& elastic, Result result) {
  const double reach = s.parameters.length;
  if (elastic.bearing >= 0) {
    const BearingParameters& bearing = s.parameters.bearings[slot(elastic.bearing)];
    Eigen::Matrix<double, 6, 1> place; // of the shifts and turns
    place << Vec3::Constant(reach), Vec3::Ones();
    const Eigen::Matrix<double, 6, 1> along = bearing.stiffness.cwiseAbs() * place;
    return result >= Result::couple_x ? along.tail<3>().norm() : along.head<3>().norm();
  }
  const std::size_t n = slot(elastic.spring);
  const double length = spring_state(s.system.springs[n], s.parameters.springs[n], s.kinematics).length;
  return std::abs(s.parameters.springs[n].pull_slope(length)) * reach;
}

double MeasureSet::rounding_size(const MeasuredState& s, std::size_t i) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const double reach = s.parameters.length, size = std::abs(found_[i]);
  const auto motion = [&] { return motion_of(s.parameters, s.kinematics, numbers_[i].points[0]); };
  switch (quantity.result) {
  case Result::vx:
  case Result::vy:
  case Result::vz: return motion().velocity.norm();
  case Result::ax:
  case Result::ay:
  case Result::az: return motion().acceleration.norm();
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
  case Result::spring: {
    const double at = s.coordinate(places_[i].reported);
    return std::max(size, std::abs(numbers_[i].spring_slope(at)) *
                              std::max(std::abs(at), quantity.angle ? 1 : reach));
  }
  case Result::tension:
  case Result::force_x:
  case Result::force_y:
  case Result::force_z:
  case Result::force:
  case Result::couple_x:
  case Result::couple_y:
  case Result::couple_z:
  case Result::couple: return std::max(size, elastic_rounding(s, places_[i].elastic, quantity.result));
  case Result::clearance:
    if (is_clearance_of_bodies(quantity))
      return size + reach + clearance_of(s.kinematics, i).error / measure_rounding;
    return std::max(size, quantity.angle ? 1 : reach);
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
  explain_unknown_depths(out);
  const bool known = error.size() == problem.system.nv;
  const auto is_huge = [](const MeasureSolution& m) { return m.value && std::abs(*m.value) > huge; };
  if (!known && std::ranges::none_of(out, is_huge)) return out;
  gradient(problem, z.q, w, w.elsewhere());
  if (known) estimate_errors(problem, z, error, w, out);
  const Eigen::MatrixXd rates = rates_;
  for (std::size_t i = 0; i < size(); ++i) {
    MeasureSolution& m = out[i];
    if (known ? !m.value || !(m.error > std::abs(*m.value)) : !is_huge(m)) continue;
    const Eigen::VectorXd aside = known ? error : unknown_error * problem.scaling.column;
    const Eigen::VectorXd along = rates.row(static_cast<Eigen::Index>(i)).transpose().cwiseSign();
    if (!has_pole(problem, z.q, aside.cwiseProduct(along), i, *m.value, w.elsewhere())) continue;
    m.value.reset();
    m.error.reset();
    m.reason = "It is unbounded within the accuracy of the coordinates.";
  }
  return out;
}

void MeasureSet::estimate_errors(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error,
                                 const Workspace& w, std::vector<MeasureSolution>& out) const {
  // Beside the coordinates' errors what rounds: positions by the mechanism's reach, all else by its own size.
  const double epsilon = std::numeric_limits<double>::epsilon();
  const MeasuredState state{problem.system, problem.parameters, z.q, w.kinematics};
  for (std::size_t i = 0; i < size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double estimate = rates_.row(row).cwiseAbs() * error;
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const double part = std::abs(partials_(row, static_cast<Eigen::Index>(k)));
      if (part > 0) estimate += measure_rounding * part * rounding_size(state, k);
    }
    if (out[i].value && std::isfinite(estimate)) out[i].error = estimate + epsilon * std::abs(*out[i].value);
  }
}

bool MeasureSet::has_pole(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& error,
                          std::size_t measure, double value, Workspace& elsewhere) {
  // On and on, which the rounding of what vanishes does not do.
  for (const double side : {1., -1.}) {
    double before = std::abs(value);
    for (const double far : {1., 16., 256.}) {
      Eigen::VectorXd beside = q;
      retract<double>(problem.system, side * far * error, beside);
      const double there =
          std::abs(evaluate_at(problem, beside, elsewhere)[static_cast<Eigen::Index>(measure)]);
      if (!(there < 0.5 * before)) return false;
      before = there;
    }
  }
  return true;
}

void MeasureSet::explain_unknown_depths(std::vector<MeasureSolution>& out) const {
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (!std::isnan(found_[k]) || !is_clearance_of_bodies(plan_.quantities()[k])) continue;
    const std::vector<bool> users = plan_.users_of(k);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (users[i] && !out[i].value)
        out[i].reason = "A cylinder is within another shape here; how deep is known of others only.";
  }
}

namespace {

// Whether what is asked of a joint's reaction is.
bool is_open(const OpenWrench& open, Result result) {
  switch (result) {
  case Result::reaction_x: return open.force.component(0);
  case Result::reaction_y: return open.force.component(1);
  case Result::reaction_z: return open.force.component(2);
  case Result::reaction: return open.force.any();
  case Result::moment_x: return open.torque.component(0);
  case Result::moment_y: return open.torque.component(1);
  case Result::moment_z: return open.torque.component(2);
  default: return open.torque.any();
  }
}

} // namespace

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
                                  return r.joint == joint && is_open(r.open, quantity.result);
                                });
    if (!shared) continue;
    const std::vector<bool> users = plan_.users_of(k);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i].nonunique = out[i].nonunique || users[i];
  }
}

} // namespace flyball
