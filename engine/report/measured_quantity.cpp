#include "engine/report/measured_quantity.hpp"

#include "engine/system/bearing.hpp"
#include "engine/system/point_quantity.hpp"
#include "engine/system/residual.hpp"

#include <limits>

namespace flyball {
namespace {

ArgumentKind kind_of(const ResultQuantity& quantity) {
  return argument_kind(result_function(quantity.result), static_cast<std::size_t>(quantity.count));
}

// Of a coordinate's spring.
template <class N>
BoundLaw law_of(const System& system, const BasicParameters<N>& p, const ResultQuantity::Of& of) {
  for (const ForceLawElement& e : system.coordinate_laws) {
    const Link& link = system.links[static_cast<std::size_t>(e.at)];
    if (system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint == of.part &&
        link.coordinate + e.component == of.coordinate)
      return p.links[static_cast<std::size_t>(e.at)]
          .force[static_cast<std::size_t>(e.component)]
          .laws->spring;
  }
  return {};
}

template <class N>
N component(const Vec3T<N>& v, Result result, Result first) {
  return v[static_cast<int>(result) - static_cast<int>(first)];
}

} // namespace

bool is_clearance_of_bodies(const ResultQuantity& quantity) {
  return quantity.result == Result::clearance && kind_of(quantity) == ArgumentKind::body;
}

template <class N>
N BasicQuantityNumbers<N>::clearance(N q) const {
  const N none = std::numeric_limits<double>::infinity();
  const N below = lower ? q - *lower : none, above = upper ? *upper - q : none;
  return above < below ? above : below;
}

template <class N>
double BasicQuantityNumbers<N>::clearance_slope(double q) const {
  if (!lower || !upper) return lower ? 1 : -1;
  return static_cast<double>(*upper) - q > q - static_cast<double>(*lower) ? 1 : -1;
}

template <class N>
void take_numbers(const ResultQuantity& quantity, const System& system, const BasicParameters<N>& p,
                  const Mechanism& m, const NumberReader<N>& read, BasicQuantityNumbers<N>& out) {
  const ArgumentKind kind = kind_of(quantity);
  if (kind == ArgumentKind::point)
    for (std::size_t n = 0; n < static_cast<std::size_t>(quantity.count); ++n)
      out.points[n] = tracked_point(system, p, m, quantity.of[n], read);
  if (kind == ArgumentKind::coordinate) {
    const Coordinate& c = m.joints[static_cast<std::size_t>(quantity.of[0].part)]
                              .coordinates[static_cast<std::size_t>(quantity.of[0].coordinate)];
    if (c.spring) {
      out.stiffness = read(c.spring->stiffness);
      out.free = read(c.spring->free);
      out.law = law_of(system, p, quantity.of[0]);
    }
    out.lower = out.upper = std::nullopt;
    if (c.stop && c.stop->lower) out.lower = read(*c.stop->lower);
    if (c.stop && c.stop->upper) out.upper = read(*c.stop->upper);
  }
  if (is_clearance_of_bodies(quantity))
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      out.solids[i].clear();
      add_solids(system, p, m, quantity.of[i].part, read, out.solids[i]);
    }
  if (quantity.result == Result::mass) {
    out.mass = 0;
    for (std::size_t b = 0; b < m.bodies.size(); ++b)
      if (quantity.count == 0 || static_cast<std::size_t>(quantity.of[0].part) == b)
        out.mass += read(m.bodies[b].mass);
  }
}

template <class N>
N quantity_value(const ResultQuantity& quantity, const BasicQuantityNumbers<N>& numbers,
                 const ElasticPlace& elastic, const System& system, const BasicParameters<N>& p,
                 const Kinematics<N>& k) {
  const auto motion = [&] { return motion_of(p, k, numbers.points[0]); };
  const auto state = [&] {
    const auto s = static_cast<std::size_t>(elastic.spring);
    return spring_state<N>(system.springs[s], p.springs[s], k);
  };
  if (elastic.bearing >= 0) {
    const auto b = static_cast<std::size_t>(elastic.bearing);
    return bearing_force<N>(quantity.result, system.bearings[b], p.bearings[b], k);
  }
  const auto force = [&]() -> Vec3T<N> { // on the second body
    const SpringState<N> s = state();
    const BasicPointSpringParameters<N>& spring = p.springs[static_cast<std::size_t>(elastic.spring)];
    if (spring.without_length()) return spring.stiffness * (s.a - s.b); // they may meet
    return -s.tension * s.direction;
  };
  switch (quantity.result) {
  case Result::x:
  case Result::y:
  case Result::z:
  case Result::vx:
  case Result::vy:
  case Result::vz:
  case Result::speed:
  case Result::distance:
  case Result::angle: return point_quantity<N>(quantity.result, numbers.points, p, k);
  case Result::ax:
  case Result::ay:
  case Result::az: return component<N>(motion().acceleration, quantity.result, Result::ax);
  case Result::acceleration: return motion().acceleration.norm();
  case Result::length: return state().length;
  case Result::tension: return state().tension;
  case Result::force_x:
  case Result::force_y:
  case Result::force_z: return component<N>(force(), quantity.result, Result::force_x);
  case Result::force: return force().norm();
  case Result::mass: return numbers.mass;
  default: return std::numeric_limits<double>::quiet_NaN(); // asked of other things
  }
}

template struct BasicQuantityNumbers<double>;
template struct BasicQuantityNumbers<Dual>;
template void take_numbers(const ResultQuantity&, const System&, const Parameters&, const Mechanism&,
                           const NumberReader<double>&, QuantityNumbers&);
template void take_numbers(const ResultQuantity&, const System&, const BasicParameters<Dual>&,
                           const Mechanism&, const NumberReader<Dual>&, BasicQuantityNumbers<Dual>&);
template double quantity_value(const ResultQuantity&, const QuantityNumbers&, const ElasticPlace&,
                               const System&, const Parameters&, const Kinematics<double>&);
template Dual quantity_value(const ResultQuantity&, const BasicQuantityNumbers<Dual>&, const ElasticPlace&,
                             const System&, const BasicParameters<Dual>&, const Kinematics<Dual>&);

} // namespace flyball
