#include "engine/dynamics/event_elements.hpp"

#include "engine/system/rotation_vector.hpp"

namespace flyball {

std::vector<StopElement> list_stops(const System& system, const Parameters& p) {
  std::vector<StopElement> out;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    if (system.links[i].v < 0) continue;
    for (int k = 0; k < (system.links[i].type == LinkType::spherical ? 3 : 1); ++k) {
      const CoordinateForce& f = p.links[i].force[static_cast<std::size_t>(k)];
      if (f.stop_stiffness == 0) continue;
      if (f.has_lower) out.push_back({static_cast<int>(i), k, false, f.lower, f.stop_stiffness});
      if (f.has_upper) out.push_back({static_cast<int>(i), k, true, f.upper, f.stop_stiffness});
    }
  }
  return out;
}

double value_at_stop(const MotionModel& model, const StopElement& stop, const Eigen::VectorXd& q) {
  const auto l = static_cast<std::size_t>(stop.link);
  const Link& link = model.system.links[l];
  if (link.type != LinkType::spherical) return q[link.q] - stop.limit;
  return rotation_vector(link, model.parameters.links[l], q)[stop.component] - stop.limit;
}

double rate_at_stop(const MotionModel& model, const StopElement& stop, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u) {
  const auto l = static_cast<std::size_t>(stop.link);
  const Link& link = model.system.links[l];
  if (link.type != LinkType::spherical) return u[link.v];
  return rotation_vector_rate(link, model.parameters.links[l], q).row(stop.component) * u.segment<3>(link.v);
}

std::vector<FlipElement> list_flips(const System& system, const Parameters& p) {
  std::vector<FlipElement> out;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    if (system.links[i].v < 0 || system.links[i].type != LinkType::spherical) continue;
    if (p.links[i].elastic || p.links[i].force[0].damped() || p.links[i].force[1].damped() ||
        p.links[i].force[2].damped())
      out.push_back({static_cast<int>(i), true});
  }
  return out;
}

Quat joint_rotation(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q) {
  const Quat d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
  return (link.reversed ? d.conjugate() : d) * p.drawn_rotation;
}

Quat joint_rotation(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q) {
  const auto l = static_cast<std::size_t>(flip.link);
  return joint_rotation(model.system.links[l], model.parameters.links[l], q);
}

double flip_rate(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& u) {
  const Link& link = model.system.links[static_cast<std::size_t>(flip.link)];
  const Quat turning(0, u[link.v], u[link.v + 1], u[link.v + 2]);
  Eigen::VectorXd turned = q;
  const Quat d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
  const Quat rate = turning * d;
  turned.segment<4>(link.q) << rate.w(), rate.vec();
  return joint_rotation(model, flip, turned).w() / 2;
}

double flip_energy(const MotionModel& model, const FlipElement& flip, const Eigen::VectorXd& q) {
  const auto l = static_cast<std::size_t>(flip.link);
  const LinkParameters& p = model.parameters.links[l];
  const Vec3 r = rotation_vector(model.system.links[l], p, q);
  double change = 0;
  for (int k = 0; k < 3; ++k) {
    const CoordinateForce& f = p.force[static_cast<std::size_t>(k)];
    change += f.energy(r[k]) - f.energy(-r[k]);
  }
  return change;
}

} // namespace flyball
