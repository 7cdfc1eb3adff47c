// How loops tie coordinates to each other.
#pragma once

#include "engine/solve/newton.hpp"

#include <span>

namespace flyball {

struct TiedMotions {
  std::vector<std::size_t> independent, others; // of the coordinates that were asked for, in their order
  // How each of the others moves with the independent ones: (others, independent).
  Eigen::MatrixXd follow;
};

// At a configuration, of coordinates of one axis by their entries in q_R. An earlier one goes before a later.
// One that does not move at all there, as at a dead point, follows from none.
TiedMotions find_tied_motions(const Problem& problem, const Eigen::VectorXd& q, std::span<const int> entries,
                              Workspace& w);

} // namespace flyball
