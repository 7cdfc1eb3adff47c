// What one link asks for by itself: by its inertia and weight, and by the springs and stops of its own
// coordinates.
#pragma once

#include "engine/system/kinematics.hpp"
#include "engine/system/rotation_vector.hpp"

namespace flyball {

// Adds what a link's inertia and weight ask for, about its origin.
template <class S>
void add_inertia_force(const LinkParametersOf<S>& lp, const LinkState<S>& x, bool moving, Vec3T<S>& force,
                       Vec3T<S>& moment) {
  if (lp.mass == NumberOf<S>(0) && !lp.has_inertia) return;
  const Vec3T<S> c = x.R * lp.com.template cast<S>();
  Vec3T<S> f = S(lp.mass) * x.dv;
  if (moving) f += S(lp.mass) * (x.dw.cross(c) + x.w.cross(x.w.cross(c)));
  force += f;
  moment += c.cross(f);
  if (!moving || !lp.has_inertia) return;
  const auto times_inertia = [&](const Vec3T<S>& a) -> Vec3T<S> {
    return x.R * (lp.inertia.template cast<S>() * (x.R.transpose() * a));
  };
  moment += times_inertia(x.dw) + x.w.cross(times_inertia(x.w));
}

// Calls add(v, force) for springs and stops of a link's own coordinates.
template <class S, class Add>
void coordinate_forces(const Link& link, const LinkParametersOf<S>& p, const Configuration<S>& q, Add add) {
  if (link.type != LinkType::spherical) {
    add(link.v, p.force[0].gradient(q[link.q]));
    return;
  }
  // With r the rotation vector and exp([d]) the step: dr = J d, so the torque is J^T dV/dr.
  const Vec3T<S> r = rotation_vector<S>(link, p, q);
  Vec3T<S> g;
  for (int i = 0; i < 3; ++i)
    g[i] = p.force[static_cast<std::size_t>(i)].gradient(r[i]);
  Vec3T<S> torque = inverse_left_jacobian<S>(r).transpose() * g;
  if (link.reversed) torque = -(p.drawn_rotation.template cast<S>() * (inverse_left_jacobian<S>(r) * g));
  for (int i = 0; i < 3; ++i)
    add(link.v + i, torque[i]);
}

} // namespace flyball
