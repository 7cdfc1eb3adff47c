// What the air does at a point of a body. With u the velocity of the air past the point,
//
//   drag   F = (linear + quadratic |u|) u
//   vane   F = rho A / 2 |u| (cn (u . n) n + cd u),   n its normal, A its area, rho the density of the air
//          F = rho A / 2 |u| (cl u' + cd u),          u' the flow turned by a right angle, along by a polar
//
// A flat plate at the angle of attack a has so the normal coefficient cn sin a, and beside the drag cd along
// the flow the lift cn sin a cos a and the induced drag cn sin^2 a: the slope of lift is cn for small angles
// (2 pi in theory for a long blade), and a plate square to the flow has cn + cd. On a blade flow along the
// span does nothing: u is taken less its part along it (the independence principle).
//
// With e the chord square to the normal, the incidence is a = atan2(u . n, u . e): 0 where the flow runs
// along the chord, from the leading edge to the trailing one, and pi / 2 where it runs along the normal. By a
// polar lift and drag have any coefficients of it, cl along u' = (u . e) n - (u . n) e, and cd: a plate's are
// those above. The force is continuous as long as they are the same at -pi and pi.
//
// Air that turns with a body moves as if it were fixed in it, and what it exerts on other bodies acts back on
// this one at the same point.
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

// The coefficients of a force of the air, the directions as drawn, without its polar.
template <class N>
void set_air_force(const Force& force, const Air& air, const NumberReader<N>& read,
                   BasicBodyForceParameters<N>& out) {
  out.type = force.type;
  out.wind = read(air.wind);
  if (force.type == ForceType::drag) {
    out.linear = read(force.linear);
    out.quadratic = read(force.quadratic);
    return;
  }
  const N pressure = read(air.density) * read(force.area) / N(2); // by the speed squared
  out.normal_quadratic = pressure * read(force.cn);
  out.quadratic = has_polar(force) ? pressure : N(pressure * read(force.cd));
  out.normal = read(force.normal).normalized();
  if (force.chord) out.span = out.normal.cross(read(*force.chord)).normalized();
}

// By a polar; `quadratic` is rho A / 2, `flow` across the span.
template <class S>
Vec3T<S> polar_force(const Polar& polar, const S& quadratic, const Vec3T<S>& normal, const Vec3T<S>& chord,
                     const Vec3T<S>& flow) {
  using std::atan2;
  const S speed = flow.norm();
  if (!(speed > S(0))) return Vec3T<S>::Zero(); // of no direction
  const S along = flow.dot(chord), up = flow.dot(normal), incidence = atan2(up, along);
  const Vec3T<S> lifted = along * normal - up * chord;
  return quadratic * speed *
         (polar.lift.template value<S>(incidence) * lifted + polar.drag.template value<S>(incidence) * flow);
}

// In world axes. `rotation` is the body's from the drawn pose; `flow` is u.
template <class S>
Vec3T<S> air_force(const BodyForceParametersOf<S>& p, const Mat3T<S>& rotation, const Vec3T<S>& flow) {
  if (p.type == ForceType::drag) return (S(p.linear) + S(p.quadratic) * flow.norm()) * flow;
  const Vec3T<S> normal = rotation * p.normal.template cast<S>(), span = rotation * p.span.template cast<S>(),
                 across = flow - span * span.dot(flow);
  if (p.polar) return polar_force<S>(*p.polar, S(p.quadratic), normal, span.cross(normal), across);
  return across.norm() * (S(p.normal_quadratic) * across.dot(normal) * normal + S(p.quadratic) * across);
}

// How it changes with the flow: dF/du, N s/m.
Mat3 air_force_slope(const BodyForceParameters& p, const Mat3& rotation, const Vec3& flow);

// On a body in air that turns with another.
template <class S>
struct TurningAirForce {
  Vec3T<S> point, flow, force; // m; m/s; N, on the body, its opposite on the other
};
template <class S>
TurningAirForce<S> turning_air_force(const TurningAirElement& e, const BodyForceParametersOf<S>& p,
                                     const Kinematics<S>& k) {
  TurningAirForce<S> out;
  out.point = k.point(e.ends.b, p.at);
  out.flow = k.velocity(e.ends.a, out.point) - k.velocity(e.ends.b, out.point);
  out.force = air_force<S>(p, k.at(e.ends.b).R, out.flow);
  return out;
}

} // namespace flyball
