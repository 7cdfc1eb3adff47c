// How measures change along steps of the coordinates and with numbers of the mechanism.
#include "engine/report/measures.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/point_quantity.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr int largest_for_differences = 64; // coordinates: the balance is evaluated twice for each

Vec3 place_of(const MeasuredState& s, const TrackedPoint& point) {
  return s.kinematics.point(point.link, point.at);
}

// Adds `factor` times a coordinate's rates.
void add_coordinate_rates(const MeasuredState& s, int reported, double factor, Eigen::VectorXd& out) {
  const ReportedCoordinate& r = s.system.reported[static_cast<std::size_t>(reported)];
  if (r.cut < 0) {
    out += factor * coordinate_gradient(s.system, s.parameters, s.q,
                                        s.system.coordinates[static_cast<std::size_t>(r.coordinate)]);
    return;
  }
  const CutJoint& cut = s.system.cuts[static_cast<std::size_t>(r.cut)];
  const CutParameters& numbers = s.parameters.cuts[static_cast<std::size_t>(r.cut)];
  const JointCoordinates joint = joint_coordinates(cut, numbers, s.kinematics);
  for (const SupportColumn& column : cut.ends.support)
    out[column.v] +=
        factor * joint.rate.row(r.index).dot(relative_velocity(cut, numbers, s.kinematics, column));
}

// The force or moment whose size a quantity is, `wrench` being that of its joint; zero of other quantities.
Vec3 vector_of(ResultQuantity quantity, const JointWrench* wrench, const QuantityNumbers& numbers,
               const ElasticPlace& elastic, const Problem& problem, const Kinematics<double>& kinematics) {
  switch (quantity.result) {
  case Result::reaction: return wrench->force;
  case Result::moment: return wrench->torque;
  case Result::force:
  case Result::couple: {
    const Result first = quantity.result == Result::force ? Result::force_x : Result::couple_x;
    Vec3 out;
    for (int k = 0; k < 3; ++k) {
      quantity.result = static_cast<Result>(static_cast<int>(first) + k);
      out[k] = quantity_value(quantity, numbers, elastic, problem.system, problem.parameters, kinematics);
    }
    return out;
  }
  default: return Vec3::Zero();
  }
}

// Evaluates all at q, which is off the balance; its multipliers.
Eigen::VectorXd evaluate_beside(MeasureSet& measures, const Problem& problem, const Eigen::VectorXd& q,
                                Workspace& w) {
  Unknowns z{q, {}};
  if (measures.needs_forces())
    z = with_reported_multipliers(problem, q, 0, w);
  else
    forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
  measures.evaluate(problem, z, w);
  return z.lambda;
}

// Those of all quantities, at a state that `w` holds. `Places` are MeasureSet's.
template <class Places>
void take_vectors(const Problem& problem, const Eigen::VectorXd& lambda, const Workspace& w,
                  const MeasurePlan& plan, const Places& places, const std::vector<QuantityNumbers>& numbers,
                  std::vector<Vec3>& out) {
  const auto of_joint = [](const ResultQuantity& quantity) {
    return quantity.result == Result::reaction || quantity.result == Result::moment;
  };
  TransmittedForces forces;
  if (std::ranges::any_of(plan.quantities(), of_joint))
    forces = transmitted_forces(problem.system, problem.parameters, lambda, w.kinematics, w.residual);
  out.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ResultQuantity& quantity = plan.quantities()[i];
    const JointWrench* wrench = nullptr;
    if (of_joint(quantity))
      wrench = places[i].tree >= 0 ? &forces.tree[static_cast<std::size_t>(places[i].tree)]
                                   : &forces.cuts[static_cast<std::size_t>(places[i].cut)];
    out[i] = vector_of(quantity, wrench, numbers[i], places[i].elastic, problem, w.kinematics);
  }
}

// In the place of sizes their vectors' parts along `directions`. Off the balance a force may be far larger
// than at it, and how its size bends there is not to count.
void take_parts(const std::vector<Vec3>& vectors, const std::vector<Vec3>& directions,
                std::vector<double>& found) {
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!directions[i].isZero()) found[i] = directions[i].dot(vectors[i]);
}

} // namespace

void MeasureSet::rates(const MeasuredState& s, std::size_t i, Eigen::VectorXd& out) const {
  const ResultQuantity& quantity = plan_.quantities()[i];
  const Place& place = places_[i];
  const QuantityNumbers& numbers = numbers_[i];
  const auto along = [&](const TrackedPoint& point, const Vec3& n, Vec3 PointRates::*of) {
    visit_point_rates(s.system, s.kinematics, point,
                      [&](int v, const PointRates& rate) { out[v] += n.dot(rate.*of); });
  };
  const auto axis = [&](Result first) {
    return Vec3(Vec3::Unit(static_cast<int>(quantity.result) - static_cast<int>(first)));
  };
  const auto apart = [&](const TrackedPoint& a, const TrackedPoint& b, double factor) {
    const Vec3 n = factor * direction(place_of(s, b) - place_of(s, a));
    along(b, n, &PointRates::position);
    along(a, -n, &PointRates::position);
  };
  const TrackedPoint& point = numbers.points[0];
  switch (quantity.result) {
  case Result::coordinate: return add_coordinate_rates(s, place.reported, 1, out);
  case Result::x:
  case Result::y:
  case Result::z:
  case Result::vx:
  case Result::vy:
  case Result::vz:
  case Result::speed:
  case Result::distance:
  case Result::angle:
    return add_coordinate_rates(s.system, point_rates_of(quantity.result, numbers.points, s.kinematics),
                                numbers.points, s.kinematics, [&](int v, double rate) { out[v] += rate; });
  case Result::ax:
  case Result::ay:
  case Result::az: return along(point, axis(Result::ax), &PointRates::acceleration);
  case Result::acceleration:
    return along(point, direction(point_motion(s.parameters, s.kinematics, point).acceleration),
                 &PointRates::acceleration);
  case Result::length:
  case Result::tension: {
    const PointSpringElement& element = s.system.springs[static_cast<std::size_t>(place.elastic.spring)];
    const PairEnds& ends = element.ends;
    const PointSpringParameters& p = s.parameters.springs[static_cast<std::size_t>(place.elastic.spring)];
    return apart(
        {ends.a, p.a}, {ends.b, p.b},
        quantity.result == Result::length ? 1 : p.pull_slope(spring_state(element, p, s.kinematics).length));
  }
  case Result::spring:
    return add_coordinate_rates(s, place.reported, numbers.spring_slope(s.coordinate(place.reported)), out);
  case Result::clearance: {
    if (!is_clearance_of_bodies(quantity)) {
      const double slope = numbers.clearance_slope(s.coordinate(place.reported));
      return add_coordinate_rates(s, place.reported, slope, out);
    }
    // What the nearest points do along the surfaces changes their distance in second order only.
    const Clearance least = clearance_of(s.kinematics, i);
    if (!std::isfinite(least.gap)) return;
    along(least.b, least.normal, &PointRates::position);
    along(least.a, -least.normal, &PointRates::position);
    return;
  }
  default: return; // constant, or by differences
  }
}

// Of the quantities that have no other rates.
void MeasureSet::difference(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  constexpr double h = 1e-5; // of a radian, or of the reach
  const std::vector<double> here = found_;
  std::vector<double> forth;
  std::vector<Vec3> directions, vectors;
  const auto look = [&](const Eigen::VectorXd& at, std::vector<Vec3>& out) {
    take_vectors(problem, evaluate_beside(*this, problem, at, w), w, plan_, places_, numbers_, out);
  };
  look(q, directions);
  for (Vec3& each : directions)
    each = direction(each);
  Eigen::VectorXd moved, step = Eigen::VectorXd::Zero(problem.system.nv);
  for (Eigen::Index v = 0; v < problem.system.nv; ++v) {
    const double length = h * problem.scaling.column[v];
    for (const double sign : {1., -1.}) {
      step[v] = sign * length;
      moved = q;
      retract<double>(problem.system, step, moved);
      look(moved, vectors);
      take_parts(vectors, directions, found_);
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

Eigen::VectorXd MeasureSet::rates_by(const Problem& problem, const Mechanism& mechanism,
                                     const NumberRates& rates, const Eigen::VectorXd& q, const Workspace& w,
                                     const std::vector<double>& differences) {
  const System& system = problem.system;
  BasicParameters<Dual> p;
  flyball::bind(system, mechanism, rates, problem.parameters, p);
  Kinematics<Dual> k;
  const Configuration<Dual> at = q.cast<Dual>();
  forward<Dual>(system, p, at, 0, k);
  const auto coordinate = [&](const Place& place) {
    const ReportedCoordinate& r = system.reported[static_cast<std::size_t>(place.reported)];
    return coordinate_value<Dual>(system, p, at, system.coordinates[static_cast<std::size_t>(r.coordinate)]);
  };
  const auto speed = [&](const Place& place) -> Dual {
    const ReportedCoordinate& r = system.reported[static_cast<std::size_t>(place.reported)];
    const auto link =
        static_cast<std::size_t>(system.coordinates[static_cast<std::size_t>(r.coordinate)].link);
    const bool given = system.links[link].drive >= 0 && !finds_speed(system.links[link]);
    return given ? p.links[link].speed * p.speed_scale : 0;
  };
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const ResultQuantity& quantity = plan_.quantities()[i];
    const Place& place = places_[i];
    BasicQuantityNumbers<Dual>& numbers = number_rates_[i];
    take_numbers<Dual>(quantity, system, p, mechanism, NumberReader<Dual>(rates), numbers);
    double& rate = duals_[i].rate;
    duals_[i].value = found_[i];
    if (place.differenced_by_numbers) {
      rate = differences[i];
      continue;
    }
    switch (quantity.result) {
    case Result::coordinate: rate = coordinate(place).rate; break;
    case Result::rate: rate = speed(place).rate; break;
    case Result::spring: rate = numbers.spring(coordinate(place)).rate; break;
    case Result::clearance:
      if (!is_clearance_of_bodies(quantity))
        rate = numbers.clearance(coordinate(place)).rate;
      else if (const Clearance least = clearance_of(w.kinematics, i); std::isfinite(least.gap))
        rate = clearance_rate(least, k, numbers.solids[0], numbers.solids[1]);
      break;
    default: rate = quantity_value(quantity, numbers, place.elastic, system, p, k).rate;
    }
  }
  plan_.set_numbers(mechanism, rates);
  plan_.evaluate(duals_, combined_);
  plan_.set_numbers(mechanism);
  Eigen::VectorXd out(static_cast<Eigen::Index>(size()));
  std::ranges::transform(combined_, out.begin(), &Dual::rate);
  return out;
}

std::vector<double> MeasureSet::differences_by(const Problem& problem, const Mechanism& mechanism,
                                               VariedNumbers& numbers, std::size_t k,
                                               const Eigen::VectorXd& q, Workspace& w) {
  const std::vector<double> values = numbers.values(), here = found_;
  const double h = 1e-6 * (std::abs(values[k]) > 1e-100 ? std::abs(values[k]) : 1.);
  std::vector<double> sides[2], moved = values;
  std::vector<Vec3> directions, vectors;
  Parameters parameters;
  const auto look = [&](const Problem& at, std::vector<Vec3>& out) {
    take_vectors(at, evaluate_beside(*this, at, q, w), w, plan_, places_, numbers_, out);
  };
  look(problem, directions);
  for (Vec3& each : directions)
    each = direction(each);
  try {
    for (const int side : {0, 1}) {
      moved[k] = side == 0 ? values[k] + h : values[k] - h;
      numbers.set(moved);
      flyball::bind(problem.system, mechanism, parameters);
      bind(mechanism, problem.system, parameters);
      look({problem.system, parameters, problem.scaling}, vectors);
      take_parts(vectors, directions, found_);
      sides[side] = found_;
    }
    for (std::size_t i = 0; i < here.size(); ++i)
      sides[0][i] = (sides[0][i] - sides[1][i]) / (2 * h);
  } catch (const SceneError&) { // expressions make no mechanism of it
    sides[0].assign(here.size(), std::numeric_limits<double>::quiet_NaN());
  }
  numbers.set(values);
  bind(mechanism, problem.system, problem.parameters);
  found_ = here;
  return sides[0];
}

Eigen::VectorXd MeasureSet::rates_by_number(const Problem& problem, const Mechanism& mechanism,
                                            VariedNumbers& numbers, std::size_t k, const Eigen::VectorXd& q,
                                            const Eigen::VectorXd& rate, Workspace& w) {
  const auto none = static_cast<Eigen::Index>(size());
  if (rate.size() == 0) return Eigen::VectorXd::Constant(none, std::numeric_limits<double>::quiet_NaN());
  NumberRates number_rates;
  try {
    numbers.rates(k, number_rates);
  } catch (const SceneError&) { // such as of a square root at zero
    return Eigen::VectorXd::Constant(none, std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<double> differenced;
  if (differenced_by_numbers())
    differenced = differences_by(problem, mechanism, numbers, k, q, w.elsewhere());
  return rates_ * rate + rates_by(problem, mechanism, number_rates, q, w, differenced);
}

bool MeasureSet::differenced_by_numbers() const {
  return std::ranges::any_of(places_, &Place::differenced_by_numbers);
}

Eigen::MatrixXd MeasureSet::rates_along(const Problem& problem, const Mechanism& mechanism,
                                        VariedNumbers& numbers, const Eigen::VectorXd& q,
                                        std::span<const Eigen::VectorXd> rates, Workspace& w) {
  bind(mechanism, problem.system, problem.parameters);
  evaluate_at(problem, q, w);
  gradient(problem, q, w, w.elsewhere());
  Eigen::MatrixXd out(static_cast<Eigen::Index>(size()), static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t k = 0; k < numbers.size(); ++k)
    out.col(static_cast<Eigen::Index>(k)) = rates_by_number(problem, mechanism, numbers, k, q, rates[k], w);
  return out;
}

Eigen::MatrixXd MeasureSet::rates_along(const Problem& problem, const Mechanism& mechanism,
                                        std::span<const std::string> addresses, const Eigen::VectorXd& q,
                                        std::span<const Eigen::VectorXd> rates, Workspace& w) {
  bind(mechanism, problem.system, problem.parameters);
  evaluate_at(problem, q, w);
  gradient(problem, q, w, w.elsewhere());
  Eigen::MatrixXd out(static_cast<Eigen::Index>(size()), static_cast<Eigen::Index>(addresses.size()));
  for (std::size_t k = 0; k < addresses.size(); ++k) {
    // Each on a copy: a number that follows from others is not set while these are varied.
    Mechanism varied = mechanism;
    VariedNumbers number(varied, addresses.subspan(k, 1));
    out.col(static_cast<Eigen::Index>(k)) = rates_by_number(problem, varied, number, 0, q, rates[k], w);
  }
  return out;
}

} // namespace flyball
