// Derivatives of what acts between two bodies: point springs, dampers in cut joints, bearings, air that turns
// with one of them, and the constraint forces' (Phi_q^T lambda)_q. Only coordinates between the two bodies
// take part.
#pragma once

#include "engine/system/linearization.hpp"

namespace flyball {

void add_pair_stiffness(const System& system, const Parameters& parameters, const Eigen::VectorXd& lambda,
                        const Kinematics<double>& kinematics, const std::vector<ScrewRates>& screws,
                        Eigen::MatrixXd& stiffness);

void add_pair_damping(const System& system, const Parameters& parameters,
                      const Kinematics<double>& kinematics, Eigen::MatrixXd& velocity);

} // namespace flyball
