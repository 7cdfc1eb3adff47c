// The play between stops, in which a coordinate that nothing else holds may stand anywhere.
#pragma once

#include "engine/kkt/workspace.hpp"

namespace flyball {

// How many times a step (scaled) can be gone from q until a coordinate meets a stop that it does not touch;
// infinite where none lies ahead. Stops on rotation vectors do not count.
double room_to_stops(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& step);

// A step to try whether anything resists it: not beyond half of the room there is before a stop, unless it
// stands at one.
Eigen::VectorXd step_within_play(const Problem& problem, const Eigen::VectorXd& q,
                                 const Eigen::VectorXd& step);

} // namespace flyball
