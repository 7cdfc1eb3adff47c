// How points of bodies move.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/system/kinematics.hpp"

#include <functional>

namespace flyball {

using TrackedPoint = BasicTrackedPoint<double>;

// Throws SceneError where there is no such body; "ground" is none.
TrackedPoint find_point(const System& system, const Mechanism& mechanism, const Parameters& parameters,
                        const BodyPoint& point);

// The same of a body's mass centre or of a named point that it or the ground (-1) carries, as expressions ask
// for it.
template <class N>
BasicTrackedPoint<N> tracked_point(const System& system, const BasicParameters<N>& p, const Mechanism& m,
                                   const ResultQuantity::Of& of, const NumberReader<N>& read) {
  const Vec3T<N> drawn = read(of.point >= 0 ? m.points[static_cast<std::size_t>(of.point)].at
                                            : m.bodies[static_cast<std::size_t>(of.part)].position);
  if (of.part < 0) return {-1, drawn - p.origin};
  const int link = system.body_link[static_cast<std::size_t>(of.part)];
  return {link, drawn - p.origin - p.links[static_cast<std::size_t>(link)].origin};
}

// At evaluated kinematics: with only the drives turning as forward() leaves them, or of any motion as move()
// does.
PointMotion point_motion(const Parameters& parameters, const Kinematics<double>& kinematics,
                         const TrackedPoint& point);

// World frame: m, m/s, m/s^2.
template <class N>
struct BasicPointMotion {
  Vec3T<N> position, velocity, acceleration;
};
// The same, instantiated for double and Dual.
template <class N>
BasicPointMotion<N> motion_of(const BasicParameters<N>& parameters, const Kinematics<N>& kinematics,
                              const BasicTrackedPoint<N>& point);

// How a point changes as one coordinate of q_R moves at unit rate, in the field of motion that the drives
// make (q_R' = 0). What lies beyond the coordinate is displaced as a rigid body in the carrier's frame P, and
// with it its motion relative to P, while P's own motion is felt at the new place:
//   v = v_P(x) + v_rel,  a = a_P(x) + 2 w_P x v_rel + a_rel.
struct PointRates {
  Vec3 position, velocity, acceleration; // a rad or m
};

// Calls act(v, rates of the point) for every coordinate of q_R that moves it.
void visit_point_rates(const System& system, const Kinematics<double>& kinematics, const TrackedPoint& point,
                       const std::function<void(int v, const PointRates& rates)>& act);

} // namespace flyball
