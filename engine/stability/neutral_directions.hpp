// Directions along which nothing resists a steady state: null directions of the balance that lead to other
// balanced states at a distance.
#pragma once

#include "engine/solve/factored_state.hpp"
#include "engine/stability/phase_stiffness.hpp"

namespace flyball {

// Of null directions (scaled, by column) those along which tied angles do not drift: a balance at other
// speeds that would turn what springs and loops tie is none of a steady state.
Eigen::MatrixXd without_drift(const FactoredState& at, const PhaseStiffness& angles,
                              const Eigen::MatrixXd& null_space);

struct NeutralDirections {
  int count = 0;
  std::vector<int> coordinates; // of q_R that take part
  Eigen::MatrixXd directions;   // (nv, count), scaled
};
// Those of the null directions (scaled, by column) along which it stays balanced, of a dense problem.
NeutralDirections neutral_directions(const FactoredState& at, const Eigen::MatrixXd& null_space);

} // namespace flyball
