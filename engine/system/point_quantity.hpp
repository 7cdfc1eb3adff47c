// Numbers that the places and velocities of points make, as measures and the laws of drives ask for them:
// x() to vz() and speed() of a point, the distance() of two, the angle() at the second of three; and what
// springs between two points exert, tension() and force().
#pragma once

#include "engine/system/point_motion.hpp"
#include "engine/system/residual.hpp"

#include <array>
#include <functional>

namespace flyball {

template <class N>
using BasicTrackedPoints = std::array<BasicTrackedPoint<N>, 3>;
using TrackedPoints = BasicTrackedPoints<double>;

bool is_of_velocity(Result of_points);

// m, m/s or rad; not a number where an angle has no arm. Instantiated for double, Dual and Extended.
template <class S>
NumberOf<S> point_quantity(Result of_points, const BasicTrackedPoints<NumberOf<S>>& points,
                           const ParametersOf<S>& parameters, const Kinematics<S>& kinematics);

// How it changes with the places and velocities of its points: 1 or 1/m, of forces N/m and N s/m. Zero where
// two points meet and where nothing moves, which have no slope; and not a number where an angle is 0 or pi.
struct PointQuantityRates {
  std::array<Vec3, 3> place{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()},
      velocity{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};
PointQuantityRates point_rates_of(Result of_points, const TrackedPoints& points,
                                  const Kinematics<double>& kinematics);

// tension() to force().
bool is_spring_force(Result result);
// Of a spring between two points with its damper (N), and its rates by these points.
template <class S>
S spring_force(Result result, const PointSpringElement& element, const PointSpringParametersOf<S>& parameters,
               const Kinematics<S>& kinematics) {
  using std::abs;
  const SpringState<S> s = spring_state<S>(element, parameters, kinematics);
  if (result == Result::tension) return s.tension;
  if (result == Result::force) return abs(s.tension);
  const int axis = static_cast<int>(result) - static_cast<int>(Result::force_x);
  if (parameters.without_length()) return S(parameters.stiffness) * (s.a - s.b)[axis]; // they may meet
  return -s.tension * s.direction[axis];
}
PointQuantityRates spring_force_rates(Result result, const PointSpringElement& element,
                                      const PointSpringParameters& parameters,
                                      const Kinematics<double>& kinematics);

// v / |v|; of no length none.
inline Vec3 direction(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

// Calls add(v, rate) with the rates along the coordinates of q_R, several times for one where it moves
// several of the points: of the motion in which only the drives turn.
template <class Add>
void add_coordinate_rates(const System& system, const PointQuantityRates& of, const TrackedPoints& points,
                          const Kinematics<double>& k, const Add& add) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto act = [&](int v, const PointRates& rates) { add(v, of.place[i].dot(rates.position)); };
    if (!of.place[i].isZero(0)) visit_point_rates(system, k, points[i], std::cref(act));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto act = [&](int v, const PointRates& rates) { add(v, of.velocity[i].dot(rates.velocity)); };
    if (!of.velocity[i].isZero(0)) visit_point_rates(system, k, points[i], std::cref(act));
  }
}

// The same along the rates of the coordinates.
template <class Add>
void add_velocity_rates(const System& system, const PointQuantityRates& of, const TrackedPoints& points,
                        const Kinematics<double>& k, const Add& add) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto act = [&](int v, const PointRates& rates) { add(v, of.velocity[i].dot(rates.position)); };
    if (!of.velocity[i].isZero(0)) visit_point_rates(system, k, points[i], std::cref(act));
  }
}

} // namespace flyball
