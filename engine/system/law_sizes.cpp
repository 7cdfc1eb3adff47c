#include "engine/system/law_sizes.hpp"

#include "engine/system/drive_torque.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

bool has_spring_law(const std::shared_ptr<const ForceLaws>& laws) {
  return laws && laws->spring;
}

void add_coordinate_springs(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q,
                            Eigen::VectorXd& force) {
  if (link.type != LinkType::spherical) {
    const CoordinateForce& c = p.force[0];
    if (has_spring_law(c.laws))
      force[link.v] += law_size(c.laws->spring, q[link.q] - c.laws->free, q[link.q]);
    return;
  }
  const Vec3 r = rotation_vector(link, p, q);
  double size = 0; // the torque mixes all components
  for (int i = 0; i < 3; ++i)
    if (const CoordinateForce& c = p.force[static_cast<std::size_t>(i)]; has_spring_law(c.laws))
      size += law_size(c.laws->spring, r[i] - c.laws->free, r[i]);
  force.segment<3>(link.v).array() += size;
}

} // namespace

double law_size(const BoundLaw& law, double deflection, double position) {
  const Dual force = law(Dual(deflection, 1));
  return std::abs(force.value) + std::abs(force.rate) * (std::abs(deflection) + std::abs(position));
}

void add_law_sizes(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                   const Kinematics<double>& k, Eigen::VectorXd& force) {
  for (std::size_t i = 0; i < system.links.size(); ++i)
    if (system.links[i].v >= 0 && p.links[i].elastic)
      add_coordinate_springs(system.links[i], p.links[i], q, force);
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const PointSpringParameters& spring = p.springs[i];
    if (!has_spring_law(spring.laws)) continue;
    const PointSpringElement& e = system.springs[i];
    const SpringState<double> s = spring_state(e, spring, k);
    const double size = law_size(spring.laws->spring, s.length - spring.free_length, s.length);
    for (const SupportColumn& c : e.ends.support)
      force[c.v] +=
          size * std::abs(s.direction.dot(k.columns[static_cast<std::size_t>(c.v)].at(c.second ? s.b : s.a)));
  }
  add_drive_law_sizes(system, p, q, k, force);
}

} // namespace flyball
