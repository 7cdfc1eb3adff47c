#include "engine/kkt/coordinate_gradient.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/system/rotation_vector.hpp"

#include <numbers>

namespace flyball {

Eigen::VectorXd coordinate_gradient(const System& system, const Parameters& parameters,
                                    const Eigen::VectorXd& q, const CoordinateInfo& coordinate) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(system.nv);
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  if (link.v < 0 || link.drive >= 0) return out;
  if (link.type != LinkType::spherical) {
    out[link.v] = 1;
    return out;
  }
  const Mat3 rate =
      rotation_vector_rate(link, parameters.links[static_cast<std::size_t>(coordinate.link)], q);
  out.segment<3>(link.v) = rate.row(coordinate.index - link.coordinate).transpose();
  return out;
}

std::complex<double> coordinate_change(const System& system, const Parameters& parameters,
                                       const Eigen::VectorXd& q, const CoordinateInfo& coordinate,
                                       const Eigen::VectorXcd& step) {
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  if (link.v < 0 || link.drive >= 0) return 0;
  if (link.type != LinkType::spherical) return step[link.v];
  const Mat3 rate =
      rotation_vector_rate(link, parameters.links[static_cast<std::size_t>(coordinate.link)], q);
  return rate.row(coordinate.index - link.coordinate).dot(step.segment<3>(link.v));
}

double away_from(const System& system, const Parameters& parameters, const CoordinateInfo& coordinate,
                 double value, double wanted) {
  const auto link = static_cast<std::size_t>(coordinate.link);
  const bool turns = system.links[link].type == LinkType::revolute && !parameters.links[link].elastic;
  return turns ? std::remainder(value - wanted, 2 * std::numbers::pi) : value - wanted;
}

const CoordinateInfo& free_coordinate(const System& system, std::string_view name) {
  std::string known;
  for (const CoordinateInfo& c : system.coordinates) {
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    const std::string label =
        coordinate_count(joint.type) == 1 ? joint.name : joint.name + "." + std::to_string(c.index);
    const bool driven = system.links[static_cast<std::size_t>(c.link)].drive >= 0;
    if (label == name) {
      if (driven) throw SceneError(std::string(name), "is driven; expected a free coordinate");
      return c;
    }
    if (!driven) known += (known.empty() ? "" : ", ") + label;
  }
  throw SceneError(std::string(name),
                   known.empty() ? "there is no free coordinate" : "expected one of " + known);
}

} // namespace flyball
