// Damping in a joint that closes a loop, by a number or by a law, without a coordinate of its own: the two
// bodies' velocities give its rate, so the joint may turn on and on.
#pragma once

#include "engine/system/kinematics.hpp"
#include "engine/system/parameters.hpp"
#include "engine/system/system.hpp"

namespace flyball {

// The joint's axis (unit), its point on the second end (m), the rate of its coordinate (rad/s or m/s) and
// what the damper resists with (N m or N), against the second end's motion along the axis.
template <class S>
struct CutDamperState {
  Vec3T<S> axis, b;
  S rate, resistance;
};

template <class S>
CutDamperState<S> cut_damper_state(const CutDamperElement& e, const CutDamperParametersOf<S>& p,
                                   const Kinematics<S>& k) {
  CutDamperState<S> out;
  out.axis = k.at(e.ends.a).R * p.axis.template cast<S>();
  out.b = k.point(e.ends.b, p.b);
  out.rate = e.angular ? out.axis.dot(k.at(e.ends.b).w - k.at(e.ends.a).w)
                       : out.axis.dot(k.velocity(e.ends.b, out.b) - k.velocity(e.ends.a, out.b));
  out.resistance = p.resistance(out.rate);
  return out;
}

} // namespace flyball
