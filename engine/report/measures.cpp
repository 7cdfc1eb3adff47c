#include "engine/report/measures.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr int largest_for_differences = 64; // coordinates: the balance is evaluated twice for each

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

// How a point changes as one coordinate of q_R moves at unit rate, in the field of motion that the drives
// make (q_R' = 0). What lies beyond the coordinate is displaced as a rigid body in the carrier's frame P, and
// with it its motion relative to P, while P's own motion is felt at the new place:
//   v = v_P(x) + v_rel,  a = a_P(x) + 2 w_P x v_rel + a_rel.
struct PointRates {
  Vec3 position, velocity, acceleration; // a rad or m
};

PointRates point_rates(const Column<double>& column, const LinkState<double>& carrier,
                       const LinkState<double>& link, const Vec3& x) {
  const Vec3 arm = x - link.o, from = x - carrier.o;
  const Vec3& w = carrier.w;
  const Vec3 velocity = link.v + link.w.cross(arm);
  const Vec3 relative = velocity - carrier.v - w.cross(from);
  const Vec3 dx = column.at(x);
  PointRates out{dx, w.cross(dx), carrier.dw.cross(dx) + w.cross(w.cross(dx))};
  if (!column.angular) return out;
  const Vec3 acceleration = link.dv + link.dw.cross(arm) + link.w.cross(link.w.cross(arm));
  const Vec3 carried = carrier.dv + carrier.dw.cross(from) + w.cross(w.cross(from));
  const Vec3 relative_acceleration = acceleration - carried - 2 * w.cross(relative);
  const Vec3 turned = column.axis.cross(relative);
  out.velocity += turned;
  out.acceleration += 2 * w.cross(turned) + column.axis.cross(relative_acceleration);
  return out;
}

// Calls act(v, rates of the point) for every coordinate of q_R that moves it.
template <class Act>
void visit_rates(const MeasuredState& s, const TrackedPoint& point, Act act) {
  const Kinematics<double>& k = s.kinematics;
  const Vec3 x = position(k, point);
  for (int l = point.link; l >= 0; l = s.system.links[slot(l)].parent) {
    const Link& link = s.system.links[slot(l)];
    if (link.v < 0) continue;
    const int count = link.type == LinkType::spherical ? 3 : 1;
    for (int v = link.v; v < link.v + count; ++v)
      act(v, point_rates(k.columns[slot(v)], k.at(link.parent), k.at(point.link), x));
  }
}

PointMotion motion_of(const MeasuredState& s, const TrackedPoint& point) {
  return point_motion(s.parameters, s.kinematics, point);
}

// v / |v|; of no length none, so that what has no rate has the rate zero.
Vec3 direction(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

double angle_between(const Vec3& a, const Vec3& b) {
  if (a.squaredNorm() == 0 || b.squaredNorm() == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Points of two lines that are nearest to each other, as parts of the way along each (Ericson, Real-Time
// Collision Detection, 2005, 5.1.9).
struct Nearest {
  double s = 0, t = 0;
};
Nearest nearest(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2) {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  if (a == 0 && e == 0) return {};
  if (a == 0) return {0, std::clamp(f / e, 0., 1.)};
  const double c = d1.dot(r);
  if (e == 0) return {std::clamp(-c / a, 0., 1.), 0};
  const double b = d1.dot(d2), denominator = a * e - b * b;
  double s = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0., 1.) : 0;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0., 1.);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0., 1.);
  }
  return {s, t};
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
    if (quantity.result == Result::clearance && kind == ArgumentKind::body) {
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
    switch (argument_kind(result_function(quantity.result), slot(quantity.count))) {
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

namespace {

// Of a joint as listed.
double coordinate_at(const MeasuredState& s, int reported) {
  if (!s.coordinates.empty()) return s.coordinates[slot(reported)];
  const ReportedCoordinate& r = s.system.reported[slot(reported)];
  if (r.cut >= 0)
    return joint_coordinates(s.system.cuts[slot(r.cut)], s.parameters.cuts[slot(r.cut)], s.kinematics)
        .value[slot(r.index)];
  const CoordinateInfo& c = s.system.coordinates[slot(r.coordinate)];
  const double value = coordinate_value(s.system, s.parameters, s.q, c);
  return turns_freely(s.system, s.parameters, c.link) ? wrapped_angle(value) : value;
}

double rate_at(const MeasuredState& s, int reported) {
  if (!s.rates.empty()) return s.rates[slot(reported)];
  const ReportedCoordinate& r = s.system.reported[slot(reported)];
  if (r.cut >= 0) {
    const CutJoint& cut = s.system.cuts[slot(r.cut)];
    const CutParameters& numbers = s.parameters.cuts[slot(r.cut)];
    return joint_coordinates(cut, numbers, s.kinematics).rate.row(r.index) *
           relative_velocity(cut, numbers, s.kinematics);
  }
  const auto link = slot(s.system.coordinates[slot(r.coordinate)].link);
  if (finds_speed(s.system.links[link])) return s.q[s.system.links[link].q];
  return s.system.links[link].drive >= 0 ? s.parameters.links[link].speed * s.parameters.speed_scale : 0;
}

// Adds `factor` times a coordinate's rates.
void add_coordinate_rates(const MeasuredState& s, int reported, double factor, Eigen::VectorXd& out) {
  const ReportedCoordinate& r = s.system.reported[slot(reported)];
  if (r.cut < 0) {
    out +=
        factor * coordinate_gradient(s.system, s.parameters, s.q, s.system.coordinates[slot(r.coordinate)]);
    return;
  }
  const CutJoint& cut = s.system.cuts[slot(r.cut)];
  const CutParameters& numbers = s.parameters.cuts[slot(r.cut)];
  const JointCoordinates joint = joint_coordinates(cut, numbers, s.kinematics);
  for (const SupportColumn& column : cut.ends.support)
    out[column.v] +=
        factor * joint.rate.row(r.index).dot(relative_velocity(cut, numbers, s.kinematics, column));
}

} // namespace

double MeasureSet::clearance(const MeasuredState& s, const Place& place, Eigen::VectorXd* rates) const {
  if (place.last_solid == place.first_solid) {
    const double q = coordinate_at(s, place.reported), infinite = std::numeric_limits<double>::infinity();
    const double below = place.lower ? q - *place.lower : infinite;
    const double above = place.upper ? *place.upper - q : infinite;
    if (rates) add_coordinate_rates(s, place.reported, below < above ? 1 : -1, *rates);
    return std::min(below, above);
  }
  double least = std::numeric_limits<double>::infinity();
  const Solid *one = nullptr, *other = nullptr;
  Nearest way;
  for (std::size_t i = place.first_solid; i < place.second_solid; ++i)
    for (std::size_t j = place.second_solid; j < place.last_solid; ++j) {
      const Solid &a = solids_[i], &b = solids_[j];
      const Vec3 a0 = position(s.kinematics, a.from), a1 = position(s.kinematics, a.to),
                 b0 = position(s.kinematics, b.from), b1 = position(s.kinematics, b.to);
      const Nearest near = nearest(a0, a1, b0, b1);
      const double gap = (b0 + near.t * (b1 - b0) - a0 - near.s * (a1 - a0)).norm() - a.radius - b.radius;
      if (gap >= least) continue;
      least = gap;
      one = &a;
      other = &b;
      way = near;
    }
  if (!rates || !one) return least;
  // What the nearest points do along the lines changes their distance in second order only.
  const TrackedPoint a{one->from.link, one->from.at + way.s * (one->to.at - one->from.at)},
      b{other->from.link, other->from.at + way.t * (other->to.at - other->from.at)};
  const Vec3 n = direction(position(s.kinematics, b) - position(s.kinematics, a));
  visit_rates(s, b, [&](int v, const PointRates& rate) { (*rates)[v] += n.dot(rate.position); });
  visit_rates(s, a, [&](int v, const PointRates& rate) { (*rates)[v] -= n.dot(rate.position); });
  return least;
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
  case Result::coordinate: return coordinate_at(s, place.reported);
  case Result::rate: return rate_at(s, place.reported);
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
  case Result::spring: return -place.stiffness * (coordinate_at(s, place.reported) - place.free);
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
    return place.drive < 0 ? none : s.forces->drives[slot(place.drive)] * rate_at(s, place.reported);
  case Result::clearance: return clearance(s, place, nullptr);
  case Result::mass: break;
  }
  return place.mass;
}

void MeasureSet::rates(const MeasuredState& s, std::size_t i, Eigen::VectorXd& out) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const Place& place = places_[i];
  const auto along = [&](const TrackedPoint& point, const Vec3& n, Vec3 PointRates::*of) {
    visit_rates(s, point, [&](int v, const PointRates& rate) { out[v] += n.dot(rate.*of); });
  };
  const auto axis = [&](Result first) {
    return Vec3(Vec3::Unit(static_cast<int>(quantity.result) - static_cast<int>(first)));
  };
  const auto apart = [&](const TrackedPoint& a, const TrackedPoint& b, double factor) {
    const Vec3 n = factor * direction(position(s.kinematics, b) - position(s.kinematics, a));
    along(b, n, &PointRates::position);
    along(a, -n, &PointRates::position);
  };
  const TrackedPoint& point = place.points[0];
  switch (quantity.result) {
  case Result::coordinate: return add_coordinate_rates(s, place.reported, 1, out);
  case Result::x:
  case Result::y:
  case Result::z: return along(point, axis(Result::x), &PointRates::position);
  case Result::vx:
  case Result::vy:
  case Result::vz: return along(point, axis(Result::vx), &PointRates::velocity);
  case Result::ax:
  case Result::ay:
  case Result::az: return along(point, axis(Result::ax), &PointRates::acceleration);
  case Result::speed: return along(point, direction(motion_of(s, point).velocity), &PointRates::velocity);
  case Result::acceleration:
    return along(point, direction(motion_of(s, point).acceleration), &PointRates::acceleration);
  case Result::distance: return apart(point, place.points[1], 1);
  case Result::angle: {
    const Vec3 corner = position(s.kinematics, place.points[1]);
    const Vec3 u = position(s.kinematics, point) - corner,
               w = position(s.kinematics, place.points[2]) - corner;
    const Vec3 a = u.normalized(), b = w.normalized();
    const double sine = a.cross(b).norm(), cosine = a.dot(b); // zero: no rate, which is not a number
    const Vec3 by_u = -(b - cosine * a) / (u.norm() * sine), by_w = -(a - cosine * b) / (w.norm() * sine);
    along(point, by_u, &PointRates::position);
    along(place.points[2], by_w, &PointRates::position);
    return along(place.points[1], -by_u - by_w, &PointRates::position);
  }
  case Result::length:
  case Result::tension: {
    const PairEnds& ends = s.system.springs[slot(place.spring)].ends;
    const PointSpringParameters& p = s.parameters.springs[slot(place.spring)];
    return apart({ends.a, p.a}, {ends.b, p.b}, quantity.result == Result::length ? 1 : p.stiffness);
  }
  case Result::spring: return add_coordinate_rates(s, place.reported, -place.stiffness, out);
  case Result::clearance: clearance(s, place, &out); return;
  default: return; // constant, or by differences
  }
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

// Of the quantities that have no other rates.
void MeasureSet::difference(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  constexpr double h = 1e-5; // of a radian, or of the reach
  const std::vector<double> here = found_;
  std::vector<double> forth;
  Eigen::VectorXd moved, step = Eigen::VectorXd::Zero(problem.system.nv);
  for (Eigen::Index v = 0; v < problem.system.nv; ++v) {
    const double length = h * problem.scaling.column[v];
    for (const double sign : {1., -1.}) {
      step[v] = sign * length;
      moved = q;
      retract<double>(problem.system, step, moved);
      evaluate_at(problem, moved, w);
      if (sign > 0) forth = found_;
    }
    step[v] = 0;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (places_[i].differenced)
        quantity_rates_(static_cast<Eigen::Index>(i), v) = (forth[i] - found_[i]) / (2 * length);
  }
  found_ = here;
}

const Eigen::MatrixXd& MeasureSet::gradient(const Problem& problem, const Eigen::VectorXd& q,
                                            const Workspace& w, Workspace& elsewhere, bool all_differences) {
  const auto count = static_cast<Eigen::Index>(places_.size());
  const auto measures = static_cast<Eigen::Index>(size());
  quantity_rates_.setZero(count, problem.system.nv);
  if (all_differences || problem.system.nv <= largest_for_differences) {
    if (differenced_) difference(problem, q, elsewhere);
  } else {
    for (Eigen::Index i = 0; i < count; ++i)
      if (places_[static_cast<std::size_t>(i)].differenced)
        quantity_rates_.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const MeasuredState state{problem.system, problem.parameters, q, w.kinematics};
  Eigen::VectorXd row;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (places_[static_cast<std::size_t>(i)].differenced) continue;
    row.setZero(problem.system.nv);
    rates(state, static_cast<std::size_t>(i), row);
    quantity_rates_.row(i) = row;
  }
  partials_.resize(measures, count);
  combine();
  for (Eigen::Index i = 0; i < count; ++i) {
    Dual& seed = duals_[static_cast<std::size_t>(i)];
    seed.rate = 1;
    plan_.evaluate(duals_, combined_);
    seed.rate = 0;
    for (Eigen::Index j = 0; j < measures; ++j)
      partials_(j, i) = combined_[static_cast<std::size_t>(j)].rate;
  }
  rates_.setZero(measures, problem.system.nv);
  for (Eigen::Index j = 0; j < measures; ++j)
    for (Eigen::Index i = 0; i < count; ++i) // what does not enter may be without a rate
      if (partials_(j, i) != 0) rates_.row(j) += partials_(j, i) * quantity_rates_.row(i);
  return rates_;
}

Eigen::VectorXd MeasureSet::parameter_rates(const Problem& problem, const Mechanism& mechanism,
                                            const std::string& address, const Eigen::VectorXd& q,
                                            Workspace& w) {
  const double value = get_parameter(mechanism, address);
  const double h = 1e-6 * (std::abs(value) > 1e-100 ? std::abs(value) : 1.);
  Eigen::VectorXd sides[2];
  Mechanism varied = mechanism;
  Parameters numbers;
  try {
    VariedNumbers number(varied, {&address, 1});
    for (const int side : {0, 1}) {
      number.set(std::array{side == 0 ? value + h : value - h});
      flyball::bind(problem.system, varied, numbers);
      bind(varied, problem.system, numbers);
      sides[side] = evaluate_at({problem.system, numbers, problem.scaling}, q, w);
    }
    bind(mechanism, problem.system, problem.parameters);
    return (sides[0] - sides[1]) / (2 * h);
  } catch (const SceneError&) { // expressions make no mechanism of it
    bind(mechanism, problem.system, problem.parameters);
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(size()),
                                     std::numeric_limits<double>::quiet_NaN());
  }
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
    return largest_force_ * (quantity.angle ? reach : 1) * std::abs(rate_at(s, places_[i].reported));
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
