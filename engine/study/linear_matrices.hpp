// What a linear model is made of, at one phase of the drives.
#pragma once

#include "engine/study/linear_signals.hpp"

#include <Eigen/Core>

namespace flyball {

// In the units of the model: k coordinates, m inputs, p outputs.
struct LinearMatrices {
  Eigen::MatrixXd mass, velocity, stiffness; // (k, k)
  Eigen::MatrixXd b0, shift;                 // (k, m): b0 - (C + G) M^-1 b1, and M^-1 b1
  Eigen::MatrixXd explicit_velocity, explicit_stiffness, explicit_b; // the same times M^-1
  Eigen::MatrixXd c_position, c_rate, d;                             // (p, k), (p, m)
  Eigen::VectorXd values, error, most; // (p), see LinearModel::output_error; the most an output feels
  Eigen::MatrixXd normalised;          // (p, 2k + m), of what directions are measured by
  Eigen::VectorXd sizes;               // (2k + m), of these, in the units of the model
  // Of radians and parts of the reach: what inputs do, M^-1 not taken of it, which makes much of rounding.
  Eigen::MatrixXd force, momentum;                              // (k, m): b0 and b1
  double stiffness_size = 0, momentum_size = 0, speed_size = 0; // momentum: of M at that speed
  Eigen::VectorXd held, inertia; // (k): what a radian or part of the reach takes of each
  Eigen::VectorXd made_of;       // (k): see MotionAt::inertia
  double lost = 0;               // by M^-1 of what K and C + G are, in parts of what each coordinate feels
};

// That inputs and outputs are the same at another phase, which is known to within `rounding_of_angles` (rad).
// What is nothing beside the stiffness, or the momenta, is rounding. `values_turn`: outputs may have other
// values, as the angles that turn are states themselves. Throws Refusal.
void expect_same(const LinearMatrices& a, const LinearMatrices& b, const LinearSignals& signals,
                 bool values_turn, double rounding_of_angles);

} // namespace flyball
