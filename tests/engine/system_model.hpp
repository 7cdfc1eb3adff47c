// A mechanism opened twice: compiled by the engine, and read by the reference with the engine's tree.
#pragma once

#include "engine/system/extended.hpp"
#include "engine/system/linearization.hpp"
#include "tests/engine/reference/b_matrix.hpp"
#include "tests/support/dice.hpp"

#include <string>
#include <vector>

namespace flyball::testing {

using reference::MatrixR;
using reference::Real;
using reference::ReferenceState;
using reference::VectorR;
using test::Dice;

struct Model {
  explicit Model(const Mechanism& m, const CutChoice& choice = {});

  Mechanism mechanism; // with the engine's implicit free joints written out, as the reference needs them
  System system;
  Parameters parameters;
  std::vector<std::string> cuts; // the engine's, for the reference
  Eigen::VectorXd drawn;

  // Loop joints whose spring, stop, gear or damper makes the engine keep their coordinates, in a chain that
  // ends in a massless twin; the reference has no such coordinates.
  bool has_twins() const;
  // Dampers in cut joints, whose rates the two define differently where the joint is open.
  bool has_cut_dampers() const { return !system.cut_dampers.empty(); }

  // The engine's configuration as joint coordinates at time t of the drives.
  ReferenceState state(const Eigen::VectorXd& q, double t) const;
  // Rates of the reference's tree coordinates by those of the engine's q_R.
  MatrixR tangents(const Eigen::VectorXd& q, const reference::Tree& tree) const;
  // A step of about this size (rad; a third of it in m) in every coordinate, that keeps clear of the corners
  // of stops and of half-turns of rotation vectors, where derivatives jump.
  Eigen::VectorXd displaced(Dice& dice, double size) const;
  // Closes the loops by shortest steps; false where that fails.
  bool close(Eigen::VectorXd& q, double t) const;
};

// Everything the engine says of one state.
template <class S>
struct Point {
  Kinematics<S> kinematics;
  Residual<S> residual;
};
template <class S>
Point<S> evaluate_at(const Model& model, const Configuration<S>& q, const Configuration<S>& lambda, double t);
Linearization linearize_at(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda,
                           double t);

// Columns that span what `a` maps to zero; singular values below 1e-8 count as zero.
MatrixR null_space(const MatrixR& a);

double largest(const VectorR& v);
double largest(const MatrixR& m);

} // namespace flyball::testing
