#include "engine/stability/play.hpp"

#include <algorithm>
#include <limits>

namespace flyball {

double room_to_stops(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
  double room = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0 || link.type == LinkType::spherical || finds_speed(link)) continue;
    const CoordinateForce& force = problem.parameters.links[l].force[0];
    const double at = q[link.q], by = step[link.v] * problem.scaling.column[link.v];
    if (by > 0 && force.has_upper && at <= force.upper) room = std::min(room, (force.upper - at) / by);
    if (by < 0 && force.has_lower && at >= force.lower) room = std::min(room, (force.lower - at) / by);
  }
  return room;
}

Eigen::VectorXd step_within_play(const Problem& problem, const Eigen::VectorXd& q,
                                 const Eigen::VectorXd& step) {
  constexpr double at_stop = 1e-6; // of the step: less room is none
  const double room = room_to_stops(problem, q, step);
  return room > at_stop ? Eigen::VectorXd(std::min(1., room / 2) * step) : step;
}

} // namespace flyball
