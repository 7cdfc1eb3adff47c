#include "engine/system/potential.hpp"

#include "engine/system/bearing.hpp"

namespace flyball {

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
  for (std::size_t i = 0; i < system.body_forces.size(); ++i)
    if (p.body_forces[i].type == ForceType::force && p.body_forces[i].frame == ForceFrame::world)
      add(-p.body_forces[i].vector.dot(k.point(system.body_forces[i].link, p.body_forces[i].at)));
  return u;
}

} // namespace flyball
