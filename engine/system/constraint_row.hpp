// One equation of a cut joint: its value and its gradient.
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

// Calls add(v, dPhi/dq_v) for each coordinate that moves the row.
template <class S, class Add>
void row_gradient(const CutJoint& cut, const CutParametersOf<S>& p, const ConstraintRow& row,
                  const Kinematics<S>& k, Add add) {
  if (row.type == RowType::gear) {
    add(cut.gear_va, S(-p.ratio));
    add(cut.gear_vb, S(1));
    return;
  }
  const Vec3T<S> b = k.point(cut.ends.b, p.b);
  Vec3T<S> u, couple = Vec3T<S>::Zero();
  if (row.type == RowType::distance) {
    u = (b - k.point(cut.ends.a, p.a)).normalized();
  } else {
    u = k.at(cut.ends.a).R * p.frame[static_cast<std::size_t>(row.u)].template cast<S>();
    if (row.type == RowType::direction)
      couple = (k.at(cut.ends.b).R * p.frame[static_cast<std::size_t>(row.w)].template cast<S>()).cross(u);
  }
  for (const SupportColumn& s : cut.ends.support) {
    const Column<S>& c = k.columns[static_cast<std::size_t>(s.v)];
    S g;
    if (row.type == RowType::direction)
      g = c.angular ? c.axis.dot(couple) : S(0);
    else
      g = u.dot(c.at(b));
    add(s.v, s.second ? g : -g);
  }
}

template <class S>
S row_value(const CutJoint& cut, const CutParametersOf<S>& p, const ConstraintRow& row,
            const Configuration<S>& q, const Kinematics<S>& k) {
  if (row.type == RowType::gear) return q[cut.gear_b] - S(p.ratio) * q[cut.gear_a] - S(p.offset);
  const Vec3T<S> d = k.point(cut.ends.b, p.b) - k.point(cut.ends.a, p.a);
  if (row.type == RowType::distance) return d.norm() - S(p.length);
  const Vec3T<S> u = k.at(cut.ends.a).R * p.frame[static_cast<std::size_t>(row.u)].template cast<S>();
  if (row.type == RowType::point) return u.dot(d);
  const Vec3T<S> w = k.at(cut.ends.b).R * p.frame[static_cast<std::size_t>(row.w)].template cast<S>();
  return u.dot(w) - (row.w == 3 ? S(p.constant) : S(0));
}

// How fast its value changes at the rates of the kinematics, for a joint that closes a loop by rates.
template <class S>
S row_rate(const CutJoint& cut, const CutParametersOf<S>& p, const ConstraintRow& row,
           const Configuration<S>& q, const Kinematics<S>& k) {
  if (row.type == RowType::gear) return q[cut.gear_b] - S(p.ratio) * q[cut.gear_a];
  const LinkState<S>&a = k.at(cut.ends.a), &b = k.at(cut.ends.b);
  const Vec3T<S> pa = k.point(cut.ends.a, p.a), pb = k.point(cut.ends.b, p.b), d = pb - pa;
  const Vec3T<S> moved = k.velocity(cut.ends.b, pb) - k.velocity(cut.ends.a, pa);
  if (row.type == RowType::distance) return d.normalized().dot(moved);
  const Vec3T<S> u = a.R * p.frame[static_cast<std::size_t>(row.u)].template cast<S>();
  if (row.type == RowType::point) return u.dot(moved) + a.w.cross(u).dot(d);
  const Vec3T<S> w = b.R * p.frame[static_cast<std::size_t>(row.w)].template cast<S>();
  return a.w.cross(u).dot(w) + u.dot(b.w.cross(w));
}

} // namespace flyball
