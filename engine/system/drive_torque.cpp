#include "engine/system/drive_torque.hpp"

#include "engine/mechanism/unset_duals.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/extended.hpp"
#include "engine/system/point_quantity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <type_traits>

namespace flyball {
namespace {

// A spring's length is the distance of its ends.
Result of_points(const DriveLaw::Input& input) {
  return input.quantity.result == Result::length ? Result::distance : input.quantity.result;
}

constexpr std::size_t most_inputs = 32; // see read_drive_law
constexpr auto as_they_come = [] {
  std::array<std::size_t, most_inputs> places{};
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}();

// The numbers that a law is evaluated with, at one state. N: double, or Dual for those of the mechanism with
// their rates; S: N, or wider numbers of the kinematics alone.
template <class N, class S = N>
struct LawState {
  const System& system;
  const BasicParameters<N>& p;
  const Configuration<N>& q;
  const Kinematics<S>& k;

  N input(const DriveLaw& law, const BasicDriveLawParameters<N>& numbers, std::size_t i) const {
    const DriveLaw::Input& input = law.inputs[i];
    if (input.bearing >= 0) {
      const auto b = static_cast<std::size_t>(input.bearing);
      return static_cast<N>(bearing_force<S>(input.quantity.result, system.bearings[b], p.bearings[b], k));
    }
    if (is_spring_force(input.quantity.result)) {
      const auto s = static_cast<std::size_t>(input.spring);
      return static_cast<N>(spring_force<S>(input.quantity.result, system.springs[s], p.springs[s], k));
    }
    if (input.coordinate < 0) return point_quantity<S>(of_points(input), numbers.points[i], p, k);
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
    if (!input.rate()) {
      const N value = coordinate_value<N>(system, p, q, c);
      return input.quantity.result == Result::spring ? spring_of(c).value(value) : value;
    }
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (finds_speed(link)) return q[link.q];
    if (link.drive >= 0) return p.links[static_cast<std::size_t>(c.link)].speed * p.speed_scale;
    if constexpr (std::is_same_v<S, double>)
      if (system.drives.empty()) return turning_rate(system, c.link, k);
    return 0; // at rest in a steady state
  }

  // A coordinate's spring: its force along the coordinate, and how that changes with it.
  struct CoordinateSpringForce {
    const BasicCoordinateForce<N>& force;
    bool by_law() const { return force.laws && force.laws->spring; }
    N value(N at) const {
      return by_law() ? -force.laws->spring.value(N(at - force.laws->free))
                      : -force.stiffness * (at - force.free);
    }
    N slope(N at) const {
      return by_law() ? N(-force.laws->spring.slope(static_cast<double>(at - force.laws->free)))
                      : -force.stiffness;
    }
  };
  CoordinateSpringForce spring_of(const CoordinateInfo& c) const {
    const auto l = static_cast<std::size_t>(c.link);
    return {p.links[l].force[static_cast<std::size_t>(c.index - system.links[l].coordinate)]};
  }

  // With the rates of the numbers, and the rate 1 at one input; all that ask for the same as another are `by`
  // further on.
  Dual value(const DriveLaw& law, const BasicDriveLawParameters<N>& numbers, std::size_t varied = most_inputs,
             std::size_t moved = most_inputs, double by = 0) const {
    if (!law.expression) return numbers.value;
    UnsetDuals<most_inputs> inputs;
    for (std::size_t i = 0; i < law.inputs.size(); ++i)
      inputs[i] = input(law, numbers, i);
    if (varied < law.inputs.size()) inputs[varied].rate = 1;
    for (std::size_t i = 0; i < law.inputs.size() && moved < law.inputs.size(); ++i)
      if (law.inputs[i] == law.inputs[moved]) inputs[i].value += by;
    return law.expression->evaluate(numbers.numbers, {}, {inputs.values, law.inputs.size()}, as_they_come);
  }

  Dual value(std::size_t drive) const {
    return value(system.torques[drive].torque, p.torques[drive].torque) -
           value(system.torques[drive].load, p.torques[drive].load);
  }

  double slope(const DriveLaw& law, const DriveLawParameters& numbers, std::size_t i) const {
    return numbers.slopes.empty() ? value(law, numbers, i).rate : numbers.slopes[i];
  }

  // What the terms of a law may be in size: what it asks of points is a difference of places; and terms may
  // well cancel, and their sum vanish with what it asks for.
  double size(const DriveLaw& law, const DriveLawParameters& numbers) const {
    const Dual first = value(law, numbers, 0); // with the slope at the first input
    const double torque = std::abs(first.value);
    double out = torque, terms = 0;
    for (std::size_t i = 0; i < law.inputs.size(); ++i) {
      const double change = std::abs(i == 0 && numbers.slopes.empty() ? first.rate : slope(law, numbers, i));
      if (law.inputs[i].coordinate < 0)
        out += change * law_input_size(system, p, law, numbers, i, q, k);
      else
        terms += change * std::max(std::abs(input(law, numbers, i)), std::abs(start_of(law.inputs[i])));
    }
    if (!(terms > torque)) return out;
    // A law that is steep here alone has no such terms.
    double most = elsewhere(law, numbers, false);
    if (most < terms) most = std::max(most, elsewhere(law, numbers, true));
    return out + std::min(terms, most);
  }

  // Where the search for a speed begins that is found; else zero.
  double start_of(const DriveLaw::Input& asked) const {
    if (!asked.rate()) return 0;
    const auto l =
        static_cast<std::size_t>(system.coordinates[static_cast<std::size_t>(asked.coordinate)].link);
    return finds_speed(system.links[l]) ? p.links[l].speed : 0;
  }

  // The size of the law with coordinates and their rates at zero, or at what they begin with.
  double elsewhere(const DriveLaw& law, const DriveLawParameters& numbers, bool at_start) const {
    UnsetDuals<most_inputs> inputs;
    for (std::size_t i = 0; i < law.inputs.size(); ++i) {
      const DriveLaw::Input& asked = law.inputs[i];
      if (asked.coordinate < 0)
        inputs[i] = input(law, numbers, i);
      else
        inputs[i] = at_start ? start_of(asked) : 0;
    }
    const double out = std::abs(
        law.expression->evaluate(numbers.numbers, {}, {inputs.values, law.inputs.size()}, as_they_come)
            .value);
    return std::isfinite(out) ? out : 0;
  }

  // Calls add(row, column, derivative) for all inputs of a kind.
  template <class Add>
  void add_derivatives(const DriveLaw& law, const DriveLawParameters& numbers, bool rates, double factor,
                       int row, const Add& add) const {
    for (std::size_t i = 0; i < law.inputs.size(); ++i) {
      const DriveLaw::Input& input = law.inputs[i];
      if (input.coordinate < 0) {
        const double change = factor * slope(law, numbers, i);
        // On the kink of an angle at 0 and pi there is no rate; see kinks.hpp.
        const auto act = [&](int v, double rate) { add(row, v, std::isfinite(rate) ? change * rate : 0); };
        add_input_rates(system, p, input, numbers.points[i], k, rates, std::cref(act)); // allocates nothing
        continue;
      }
      if (input.rate() != rates) continue;
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
      const Link& link = system.links[static_cast<std::size_t>(c.link)];
      if (link.v < 0) continue;
      double change = factor * slope(law, numbers, i);
      if (input.quantity.result == Result::spring)
        change *= spring_of(c).slope(coordinate_value<N>(system, p, q, c));
      if (link.type != LinkType::spherical) {
        add(row, link.v, change);
        continue;
      }
      const Mat3 turned = rotation_vector_rate(link, p.links[static_cast<std::size_t>(c.link)], q);
      for (int j = 0; j < 3; ++j)
        add(row, link.v + j, change * turned(c.index - link.coordinate, j));
    }
  }

  template <class Add>
  void add_derivatives(bool rates, const Add& add) const {
    for (std::size_t i = 0; i < system.torques.size(); ++i) {
      const int row = system.links[static_cast<std::size_t>(system.torques[i].link)].v;
      add_derivatives(system.torques[i].torque, p.torques[i].torque, rates, -1, row, add);
      add_derivatives(system.torques[i].load, p.torques[i].load, rates, 1, row, add);
    }
  }
};

// Laws are evaluated in double precision: what they round is no more than the numbers they are given by.
template <class S>
S law_value(const System& system, const ParametersOf<S>& p, std::size_t drive, const Configuration<S>& q,
            const Kinematics<S>& k) {
  if constexpr (std::is_same_v<S, Dual>) {
    return LawState<Dual>{system, p, q, k}.value(drive);
  } else if constexpr (std::is_same_v<S, double>) {
    return LawState<double>{system, p, q, k}.value(drive).value;
  } else { // only of a steady state
    const Eigen::VectorXd rounded = q.template cast<double>();
    return S(LawState<double, S>{system, p, rounded, k}.value(drive).value);
  }
}

} // namespace

template <class S>
void add_drive_torques(const System& system, const ParametersOf<S>& p, const Configuration<S>& q,
                       const Kinematics<S>& k, Configuration<S>& f) {
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    const auto l = static_cast<std::size_t>(system.torques[i].link);
    const Link& link = system.links[l];
    if (finds_speed(link)) f[link.v] += p.links[l].force[0].resistance(q[link.q]);
    f[link.v] -= law_value<S>(system, p, i, q, k);
  }
}

void add_drive_torque_sizes(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                            const Kinematics<double>& k, Eigen::VectorXd& force) {
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    const auto l = static_cast<std::size_t>(system.torques[i].link);
    const Link& link = system.links[l];
    const LawState<double> state{system, p, q, k};
    force[link.v] += state.size(system.torques[i].torque, p.torques[i].torque) +
                     state.size(system.torques[i].load, p.torques[i].load);
    if (finds_speed(link)) {
      const CoordinateForce& own = p.links[l].force[0];
      force[link.v] += std::max(std::abs(own.resistance(q[link.q])),
                                std::abs(own.resistance_slope(q[link.q]) * p.links[l].speed));
    }
  }
}

void add_drive_law_sizes(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                         const Kinematics<double>& k, Eigen::VectorXd& force) {
  const LawState<double> state{system, p, q, k};
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    const DriveTorqueElement& drive = system.torques[i];
    double& out = force[system.links[static_cast<std::size_t>(drive.link)].v];
    if (drive.torque.expression) out += state.size(drive.torque, p.torques[i].torque);
    if (drive.load.expression) out += state.size(drive.load, p.torques[i].load);
  }
}

double drive_torque(const System& system, const Parameters& p, std::size_t drive, const Eigen::VectorXd& q,
                    const Kinematics<double>& k) {
  return LawState<double>{system, p, q, k}.value(drive).value;
}

TorqueAndLoad torque_and_load(const System& system, const Parameters& p, std::size_t drive,
                              const Eigen::VectorXd& q, const Kinematics<double>& k) {
  const LawState<double> state{system, p, q, k};
  return {state.value(system.torques[drive].torque, p.torques[drive].torque).value,
          state.value(system.torques[drive].load, p.torques[drive].load).value};
}

double law_input(const System& system, const Parameters& p, const DriveLaw& law,
                 const DriveLawParameters& numbers, std::size_t input, const Eigen::VectorXd& q,
                 const Kinematics<double>& k) {
  return LawState<double>{system, p, q, k}.input(law, numbers, input);
}

void add_input_rates(const System& system, const Parameters& p, const DriveLaw::Input& input,
                     const TrackedPoints& points, const Kinematics<double>& k, bool with_rates,
                     const std::function<void(int v, double change)>& add) {
  const Result asked = of_points(input);
  if (input.bearing >= 0)
    return bearing_force_rates(system, p, asked, static_cast<std::size_t>(input.bearing), k, with_rates, add);
  PointQuantityRates by;
  if (is_spring_force(asked)) {
    const auto s = static_cast<std::size_t>(input.spring);
    by = spring_force_rates(asked, system.springs[s], p.springs[s], k);
  } else {
    by = point_rates_of(asked, points, k);
  }
  if (with_rates)
    add_velocity_rates(system, by, points, k, add);
  else
    add_coordinate_rates(system, by, points, k, add);
}

double law_input_size(const System& system, const Parameters& p, const DriveLaw& law,
                      const DriveLawParameters& numbers, std::size_t i, const Eigen::VectorXd& q,
                      const Kinematics<double>& k) {
  const DriveLaw::Input& input = law.inputs[i];
  const double value = std::abs(law_input(system, p, law, numbers, i, q, k));
  const Result asked = of_points(input);
  if (asked == Result::spring) {
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
    const double slope =
        LawState<double>{system, p, q, k}.spring_of(c).slope(coordinate_value(system, p, q, c));
    return value + std::abs(slope) * (c.angle ? 1 : p.length);
  }
  if (asked == Result::angle) return std::max(value, 1.);
  if (input.bearing >= 0) {
    const auto b = static_cast<std::size_t>(input.bearing);
    return bearing_force_size(asked, p.bearings[b], bearing_state(system.bearings[b], p.bearings[b], k),
                              p.length);
  }
  if (is_spring_force(asked)) {
    const auto s = static_cast<std::size_t>(input.spring);
    const SpringState<double> spring = spring_state(system.springs[s], p.springs[s], k);
    return std::abs(spring.tension) + std::abs(p.springs[s].pull_slope(spring.length)) * p.length;
  }
  if (!is_of_velocity(asked)) return value + p.length;
  const LinkState<double>& x = k.at(numbers.points[i][0].link);
  return x.v.norm() + x.w.norm() * p.length;
}

bool stands_on_own_kink(const System& system, const Parameters& p, const DriveLaw& law,
                        const DriveLawParameters& numbers, std::size_t i, const Eigen::VectorXd& q,
                        const Kinematics<double>& k) {
  constexpr double near = 1e-8;
  const Result asked = of_points(law.inputs[i]);
  if (law.inputs[i].bearing >= 0) {
    // Stiff ones give way by little: what they bear is small beside their size.
    constexpr double nothing = 1e-12;
    return (asked == Result::force || asked == Result::couple) &&
           law_input(system, p, law, numbers, i, q, k) <=
               nothing * law_input_size(system, p, law, numbers, i, q, k);
  }
  if (is_spring_force(asked)) {
    const auto s = static_cast<std::size_t>(law.inputs[i].spring);
    const SpringState<double> spring = spring_state(system.springs[s], p.springs[s], k);
    const bool meets = spring.length <= near * p.length,
               smooth = p.springs[s].without_length() && asked != Result::tension && asked != Result::force;
    return (meets && !smooth) ||
           (asked == Result::force &&
            std::abs(spring.tension) <= near * law_input_size(system, p, law, numbers, i, q, k));
  }
  if (asked != Result::distance && asked != Result::angle && asked != Result::speed) return false;
  const double value = law_input(system, p, law, numbers, i, q, k);
  const double from_end = asked == Result::angle ? std::min(value, std::numbers::pi - value) : value;
  return from_end <= near * law_input_size(system, p, law, numbers, i, q, k);
}

std::vector<double> drive_law_slopes(const System& system, const Parameters& p, const DriveLaw& law,
                                     const DriveLawParameters& numbers, const Eigen::VectorXd& q,
                                     const Kinematics<double>& k, std::size_t moved, double by) {
  const LawState<double> state{system, p, q, k};
  std::vector<double> out;
  for (std::size_t i = 0; i < law.inputs.size(); ++i)
    out.push_back(state.value(law, numbers, i, moved, by).rate);
  return out;
}

std::vector<DriveTorqueEntry> drive_torque_entries(const System& system, const Parameters& p,
                                                   const Eigen::VectorXd& q, const Kinematics<double>& k,
                                                   bool rates) {
  std::vector<DriveTorqueEntry> out;
  LawState<double>{system, p, q, k}.add_derivatives(rates, [&](int row, int column, double value) {
    out.push_back({row, column, value});
  });
  return out;
}

void add_drive_torque_stiffness(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                                const Kinematics<double>& k, Eigen::MatrixXd& stiffness) {
  LawState<double>{system, p, q, k}.add_derivatives(
      false, [&](int row, int column, double value) { stiffness(row, column) += value; });
}

void add_drive_torque_damping(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                              const Kinematics<double>& k, Eigen::MatrixXd& velocity) {
  LawState<double>{system, p, q, k}.add_derivatives(
      true, [&](int row, int column, double value) { velocity(row, column) += value; });
}

double turning_rate(const System& system, int l, const Kinematics<double>& k) {
  const Link& link = system.links[static_cast<std::size_t>(l)];
  const LinkState<double>&x = k.at(l), &parent = k.at(link.parent);
  if (link.type == LinkType::revolute) return x.axis.dot(x.w - parent.w);
  return x.axis.dot(x.v - parent.v - parent.w.cross(x.o - parent.o));
}

template void add_drive_torques<double>(const System&, const Parameters&, const Configuration<double>&,
                                        const Kinematics<double>&, Configuration<double>&);
template void add_drive_torques<Extended>(const System&, const Parameters&, const Configuration<Extended>&,
                                          const Kinematics<Extended>&, Configuration<Extended>&);
template void add_drive_torques<Dual>(const System&, const BasicParameters<Dual>&, const Configuration<Dual>&,
                                      const Kinematics<Dual>&, Configuration<Dual>&);

} // namespace flyball
