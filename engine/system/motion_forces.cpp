#include "engine/system/air_force.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/motion.hpp"
#include "engine/system/pair_stiffness.hpp"
#include "engine/system/rotation_vector.hpp"

namespace flyball {
namespace {

bool damped(const LinkParameters& p) {
  return p.force[0].damped() || p.force[1].damped() || p.force[2].damped();
}

Vec3 dampings(const LinkParameters& p) {
  return {p.force[0].damping, p.force[1].damping, p.force[2].damping};
}

} // namespace

void add_coordinate_damping(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& u, Eigen::VectorXd& f) {
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    if (link.v < 0 || !damped(p.links[i])) continue;
    if (link.type == LinkType::spherical) {
      const Mat3 j = rotation_vector_rate(link, p.links[i], q);
      const Vec3 rate = j * u.segment<3>(link.v);
      f.segment<3>(link.v) += j.transpose() * dampings(p.links[i]).cwiseProduct(rate);
    } else {
      f[link.v] += p.links[i].force[0].resistance(u[link.v]);
    }
  }
}

Mat3 rotation_damping_stiffness(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q,
                                const Vec3& rate) {
  const Vec3 r = rotation_vector(link, p, q);
  const Mat3 drawn = p.drawn_rotation.toRotationMatrix();
  const Mat3 j = rotation_vector_rate(link, p, q);
  Mat3 out;
  for (int k = 0; k < 3; ++k) {
    const Mat3 turned = inverse_left_jacobian_derivative<double>(r, j.col(k));
    const Mat3 dj = link.reversed ? Mat3(-turned.transpose() * drawn.transpose()) : turned;
    out.col(k) = dj.transpose() * dampings(p).cwiseProduct(j * rate) +
                 j.transpose() * dampings(p).cwiseProduct(dj * rate);
  }
  return out;
}

void add_coordinate_damping_stiffness(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                                      const Eigen::VectorXd& u, Eigen::MatrixXd& stiffness) {
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    if (link.v < 0 || link.type != LinkType::spherical || !damped(p.links[i])) continue;
    stiffness.block<3, 3>(link.v, link.v) +=
        rotation_damping_stiffness(link, p.links[i], q, u.segment<3>(link.v));
  }
}

ForcePowers force_powers(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& u, const Kinematics<double>& k) {
  ForcePowers out;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    if (link.v < 0 || (!damped(p.links[i]) && p.links[i].force[0].friction == 0)) continue;
    if (link.type == LinkType::spherical) {
      const Vec3 rate = rotation_vector_rate(link, p.links[i], q) * u.segment<3>(link.v);
      out.dissipated += dampings(p.links[i]).dot(rate.cwiseAbs2());
    } else {
      const CoordinateForce& f = p.links[i].force[0];
      out.dissipated += (f.resistance(u[link.v]) - f.friction) * u[link.v];
    }
  }
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    if (!p.springs[i].damped()) continue;
    const double rate = stretching(system.springs[i], spring_state(system.springs[i], p.springs[i], k), k);
    out.dissipated += p.springs[i].resistance(rate) * rate;
  }
  for (std::size_t i = 0; i < system.cut_dampers.size(); ++i) {
    if (!p.cut_dampers[i].damped()) continue;
    const CutDamperState<double> s = cut_damper_state<double>(system.cut_dampers[i], p.cut_dampers[i], k);
    out.dissipated += s.resistance * s.rate;
  }
  const BearingPowers bearings = bearing_powers(system, p, k);
  out.dissipated += bearings.dissipated;
  out.applied += bearings.applied;
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceElement& e = system.body_forces[i];
    const BodyForceParameters& f = p.body_forces[i];
    if (e.link < 0 || (f.type == ForceType::force && f.frame == ForceFrame::world)) continue;
    const AppliedForce<double> a = applied_force(e, f, k);
    const double power = a.force.dot(k.velocity(e.link, a.point)) + a.torque.dot(k.at(e.link).w);
    if (is_of_air(f.type))
      out.dissipated -= power;
    else
      out.applied += power;
  }
  for (std::size_t i = 0; i < system.turning_air.size(); ++i) {
    const TurningAirForce<double> air = turning_air_force<double>(system.turning_air[i], p.turning_air[i], k);
    out.dissipated += air.force.dot(air.flow);
  }
  for (std::size_t i = 0; i < system.torques.size(); ++i)
    out.applied += drive_torque(system, p, i, q, k) *
                   u[system.links[static_cast<std::size_t>(system.torques[i].link)].v];
  return out;
}

double potential_energy(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                        const Kinematics<double>& k) {
  double energy = 0;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    const LinkParameters& lp = p.links[i];
    if (lp.mass != 0) energy -= lp.mass * p.gravity.dot(k.links[i].o + k.links[i].R * lp.com);
    if (link.v < 0 || !lp.elastic) continue;
    if (link.type == LinkType::spherical) {
      const Vec3 r = rotation_vector(link, lp, q);
      for (int j = 0; j < 3; ++j)
        energy += lp.force[static_cast<std::size_t>(j)].energy(r[j]);
    } else {
      energy += lp.force[0].energy(q[link.q]) + lp.force[0].friction * q[link.q]; // which is dissipated
    }
  }
  for (std::size_t i = 0; i < system.springs.size(); ++i)
    energy += p.springs[i].energy(spring_state(system.springs[i], p.springs[i], k).length);
  energy += bearing_energy(system, p, k);
  for (std::size_t i = 0; i < system.body_forces.size(); ++i)
    if (p.body_forces[i].type == ForceType::force && p.body_forces[i].frame == ForceFrame::world)
      energy -= p.body_forces[i].vector.dot(k.point(system.body_forces[i].link, p.body_forces[i].at));
  return energy;
}

double kinetic_energy(const System& system, const Parameters& p, const Kinematics<double>& k) {
  double energy = 0;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const LinkParameters& lp = p.links[i];
    const LinkState<double>& x = k.links[i];
    if (lp.mass != 0) energy += lp.mass * (x.v + x.w.cross(x.R * lp.com)).squaredNorm() / 2;
    if (lp.has_inertia) {
      const Vec3 w = x.R.transpose() * x.w;
      energy += w.dot(lp.inertia * w) / 2;
    }
  }
  return energy;
}

} // namespace flyball
