#include "engine/system/potential.hpp"

#include "engine/system/bearing.hpp"
#include "engine/system/residual.hpp"

namespace flyball {

namespace {

// See BodyForceElement::constant.
double constant_force_energy(const System& system, const BodyForceElement& e, const BodyForceParameters& f,
                             const Eigen::VectorXd& q, const Kinematics<double>& k) {
  double energy = 0;
  const AppliedForce<double> a = applied_force(e, f, k);
  for (int l = e.link; l >= 0;) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    l = link.parent;
    if (link.v < 0) continue;
    const Column<double>& column = k.columns[static_cast<std::size_t>(link.v)];
    energy -= (column.at(a.point).dot(a.force) + column.turn().dot(a.torque)) * q[link.q];
  }
  return energy;
}

} // namespace

Potential amended_potential(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                            const Kinematics<double>& k) {
  Potential u;
  const auto add = [&](double term) {
    u.value += term;
    u.magnitude += std::abs(term);
  };
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    const LinkParameters& lp = p.links[i];
    const LinkState<double>& x = k.links[i];
    // What no free coordinate moves adds a constant, which could drown the rest.
    if (!link.mobile) continue;
    if (lp.mass != 0) {
      const Vec3 c = x.R * lp.com;
      add(-lp.mass * p.gravity.dot(x.o + c));
      if (p.moving) add(-lp.mass * (x.v + x.w.cross(c)).squaredNorm() / 2);
    }
    if (lp.has_inertia && p.moving) {
      const Vec3 w = x.R.transpose() * x.w;
      add(-w.dot(lp.inertia * w) / 2);
    }
    if (link.v < 0 || !lp.elastic) continue;
    if (link.type == LinkType::spherical) {
      const Vec3 r = rotation_vector(link, lp, q);
      for (int j = 0; j < 3; ++j)
        add(lp.force[static_cast<std::size_t>(j)].energy(r[j]));
    } else {
      add(lp.force[0].energy(q[link.q]));
    }
  }
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const SpringState<double> s = spring_state(system.springs[i], p.springs[i], k);
    add(p.springs[i].energy(s.length));
  }
  if (!system.bearings.empty()) add(bearing_energy(system, p, k));
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceElement& e = system.body_forces[i];
    const BodyForceParameters& f = p.body_forces[i];
    if (e.constant)
      add(constant_force_energy(system, e, f, q, k));
    else if (f.type == ForceType::force && f.frame == ForceFrame::world)
      add(-f.vector.dot(k.point(e.link, f.at)));
  }
  return u;
}

} // namespace flyball
