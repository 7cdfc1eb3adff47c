#include "engine/kkt/coordinate_gradient.hpp"

#include "engine/kkt/problem.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/rotation_vector.hpp"

#include <numbers>

namespace flyball {
namespace {

std::string label_of(const System& system, const CoordinateInfo& c) {
  return coordinate_label(system.tree_joints[static_cast<std::size_t>(c.tree_joint)], c.index);
}

} // namespace

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
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  const bool turns = link.type == LinkType::revolute && !turns_matter(system, parameters, coordinate.link) &&
                     !finds_speed(link);
  return turns ? std::remainder(value - wanted, 2 * std::numbers::pi) : value - wanted;
}

double found_value(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                   const CoordinateInfo& coordinate) {
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  return finds_speed(link) ? q[link.q] : coordinate_value(system, parameters, q, coordinate);
}

Eigen::VectorXd found_gradient(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                               const CoordinateInfo& coordinate) {
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  if (finds_speed(link)) return Eigen::VectorXd::Unit(system.nv, link.v);
  return coordinate_gradient(system, parameters, q, coordinate);
}

double found_scale(const System& system, const Parameters& parameters, const CoordinateInfo& coordinate) {
  const Link& link = system.links[static_cast<std::size_t>(coordinate.link)];
  if (finds_speed(link)) return found_speed_unit(system, parameters, link);
  return coordinate.angle ? 1 : parameters.length;
}

const CoordinateInfo* coordinate_of_speed(const System& system, std::string_view name) {
  constexpr std::string_view ending = ".speed";
  if (!name.ends_with(ending)) return nullptr;
  name.remove_suffix(ending.size());
  for (const CoordinateInfo& c : system.coordinates)
    if (finds_speed(system.links[static_cast<std::size_t>(c.link)]) && name == label_of(system, c)) return &c;
  return nullptr;
}

const CoordinateInfo& free_coordinate(const System& system, std::string_view name) {
  std::string known;
  for (const CoordinateInfo& c : system.coordinates) {
    const std::string label = label_of(system, c);
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (label == name) {
      if (finds_speed(link))
        throw SceneError(std::string(name), "is driven by a torque; its speed is " + label + ".speed");
      if (link.drive >= 0) throw SceneError(std::string(name), "is driven; expected a free coordinate");
      return c;
    }
    if (link.drive < 0) known += (known.empty() ? "" : ", ") + label;
  }
  throw SceneError(std::string(name),
                   known.empty() ? "there is no free coordinate" : "expected one of " + known);
}

} // namespace flyball
