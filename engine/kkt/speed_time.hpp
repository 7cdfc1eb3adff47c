// The time by which speeds that are found are compared with coordinates.
#pragma once

#include "engine/kkt/problem.hpp"

#include <algorithm>

namespace flyball {

// s: that of a radian (or the reach) at the fastest of the units of speeds that are found, 1 where there are
// none. The rows of these are powers, of which it makes energies, so that a change of the unit of time
// changes nothing.
inline double speed_time(const Problem& problem) {
  double fastest = 0;
  for (const Link& link : problem.system.links)
    if (link.v >= 0 && finds_speed(link))
      fastest = std::max(fastest, problem.scaling.column[link.v] /
                                      (link.type == LinkType::prismatic ? problem.parameters.length : 1));
  return fastest > 0 ? 1 / fastest : 1;
}

} // namespace flyball
