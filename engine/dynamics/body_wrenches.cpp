#include "engine/dynamics/body_wrenches.hpp"

#include "engine/system/link_forces.hpp"

namespace flyball {

void set_body_wrenches(const System& system, const Parameters& p, const Kinematics<double>& k,
                       std::vector<Vec6>& out) {
  out.resize(system.links.size());
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    add_inertia_force<double>(p.links[l], k.links[l], p.moving, force, moment);
    out[l] << moment, force;
  }
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceElement& e = system.body_forces[i];
    if (e.link < 0) continue;
    const AppliedForce<double> a = applied_force(e, p.body_forces[i], k);
    Vec6& wrench = out[static_cast<std::size_t>(e.link)];
    wrench.head<3>() -= a.torque + (a.point - k.at(e.link).o).cross(a.force);
    wrench.tail<3>() -= a.force;
  }
}

void set_coordinate_forces(const System& system, const MotionPoint& point, Eigen::VectorXd& out) {
  out.setZero(system.nv);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    const LinkParameters& lp = point.parameters.links[l];
    if (link.v >= 0 && lp.elastic)
      coordinate_forces<double>(link, lp, point.q, [&](int v, double force) { out[v] += force; });
  }
  add_coordinate_damping(system, point.parameters, point.q, point.u, out);
}

} // namespace flyball
