// Whether anything moves what the law of a drive asks for. What no coordinate and no rate moves, as the
// distance of two points of one body, is a number like others: that it stands on a kink tells nothing.
#pragma once

#include "engine/kkt/problem.hpp"

#include <optional>

namespace flyball {

// To first order, as the loops let the coordinates move. Of what is the size of something, as a distance, a
// speed or an angle of 0 or pi, whether that moves: the size of what keeps vanishing has no kink. Kinematics
// at the drawn phase.
bool is_moved(const Problem& problem, const DriveLaw& law, const DriveLawParameters& numbers,
              std::size_t input, const Eigen::VectorXd& q, const Kinematics<double>& kinematics);

// Where one direction of the coordinates alone moves it, and no rate does: that direction, of length 1
// (scaled).
std::optional<Eigen::VectorXd> single_motion(const Problem& problem, const DriveLaw& law,
                                             const DriveLawParameters& numbers, std::size_t input,
                                             const Eigen::VectorXd& q, const Kinematics<double>& kinematics);

} // namespace flyball
