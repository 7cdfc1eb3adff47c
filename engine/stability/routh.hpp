// The linearised motion of drives left to themselves at the momenta they keep (Routh 1877; Meirovitch,
// Methods of Analytical Dynamics, section 2.11). Neither their phases nor what changes their momenta is seen
// in it: both zero eigenvalues of each, that of the phase and that along the family of states with other
// momenta, are gone.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

// s^2 M + s D + K on directions, orthonormal, by column.
struct LinearPencil {
  Eigen::MatrixXd mass, velocity, stiffness, directions;
  double mass_terms = 0, velocity_terms = 0; // norms of what both were made of, where something was condensed
};

// `kept`: the directions (orthonormal columns) along which nothing acts, K x = 0 and x^T K = 0. What turns
// with them is condensed: w = -M_w^-1 (s M_wx + D_wx) x. Nothing where it has no mass.
std::optional<LinearPencil> at_given_momenta(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                             const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& kept);

} // namespace flyball
