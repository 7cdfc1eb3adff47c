// Which coordinates of a mechanism are those of a linear model, and their names.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/study/linear_model.hpp"

namespace flyball {

// The same at every phase.
struct ModelCoordinates {
  std::vector<int> entries; // of q_R, ascending
  std::vector<bool> phase;  // of these: it turns at a speed that is found, and is no state
};

// The entries of q_R that turn in the steady state, at speeds that are found.
std::vector<bool> turning_entries(const System& steady);

// Independent coordinates on the null space `basis` of the loops: those that turn at speeds that are found
// first, or last where their angles matter, so that what others hold against them is told by these; the
// others by pivots (Golub and Van Loan, Matrix Computations, section 5.4). Which of them are phases is left
// open. Throws Refusal.
ModelCoordinates choose_coordinates(const System& steady, const Eigen::MatrixXd& basis, bool turning_last);

// Of an entry of q_R, or its rate: name and unit.
LinearModel::State name_state(const MotionModel& model, int v, bool rate);

} // namespace flyball
