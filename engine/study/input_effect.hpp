// The linearised motion of a mechanism with its drives as coordinates, at one phase of these, and what an
// input does to it.
#pragma once

#include "engine/kkt/constraint_space.hpp"
#include "engine/study/motion_outputs.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

// Thrown where there is no linear model, with the reason.
struct Refusal {
  std::string why;
};

// What an input does, scaled: by coordinate of q_R or of the null space.
struct InputEffect {
  Eigen::VectorXd force;       // (n) df/du at standing coordinates, speeds of drives included
  Eigen::VectorXd drive_rates; // (drives) of their speeds
  Eigen::VectorXd closing;     // (n) G
  Eigen::VectorXd b0, b1;      // (k)
  Eigen::VectorXd shift;       // (k) M^-1 b1
};

// Whether a number that has a rate places parts, so that its own rates move mass or work dampers.
bool places_parts(const BasicParameters<Dual>& parameters);

// In scaled coordinates: radians and parts of the reach.
class MotionAt {
 public:
  // About `state`, whose multipliers are found. `held`: entries of q_R that dry friction holds, as
  // constraints would.
  MotionAt(const MotionModel& model, const MotionOfAll& state, std::span<const int> held);

  const Eigen::VectorXd& column() const { return column_; } // rad or m per scaled unit, of all coordinates
  const Eigen::MatrixXd& basis() const { return basis_; }   // (n, k), orthonormal

  // x with M x = rhs, of least size where parts have no mass.
  Eigen::VectorXd accelerate(const Eigen::VectorXd& rhs) const;

  // Of an input by one unit: of the balance (N m or N, by coordinate of q_R), of the loops' rows (m, rad) and
  // of the drives' speeds. Throws Refusal, a clause, for what has no place in a linear model.
  InputEffect effect(const Eigen::VectorXd& force, const Eigen::VectorXd& rows,
                     const Eigen::VectorXd& drive_rates) const;

  // Changes of all coordinates, scaled, with the multipliers that go with them; `force`, of an input (null:
  // none), has what speeds of drives do.
  MotionDirection direction(const Eigen::VectorXd& q, const Eigen::VectorXd& u, const Eigen::VectorXd& a,
                            const Eigen::VectorXd* force) const;

  Eigen::MatrixXd mass, velocity, stiffness; // (k, k), on the basis
  Eigen::VectorXd inertia;       // (k): what a diagonal entry of the mass is made of (own_inertia())
  Eigen::Index without_mass = 0; // directions of these
  MotionOfAll at;
  // Where loops leave it open how the joints that are held share what they bear: multipliers of the loops
  // that may be added in any measure.
  std::vector<Eigen::VectorXd> open_shares;

 private:
  Eigen::MatrixXd reduced(const Eigen::MatrixXd& m) const;
  // Of the loops, of least norm with what holds; scaled force in the balance.
  Eigen::VectorXd multipliers(const Eigen::VectorXd& force) const;
  // What coordinates feel of the inertia that drives carry, as these change their speeds. Rounding, which is
  // measured by the inertias M_ii M_jj >= M_ij^2 themselves, is zero: M^-1 makes much of it in a long chain.
  Eigen::VectorXd carried(const Eigen::VectorXd& drive_rates) const;
  void find_multipliers(std::span<const int> held);
  // Throws where how much of the load it takes, of what loops leave open, is felt by small motions.
  void refuse_dead_point(const Eigen::VectorXd& share);

  const MotionModel& model_;
  int n_ = 0, drives_ = 0;
  Eigen::VectorXd column_;
  Kinematics<double> kinematics_;
  Residual<double> residual_;
  Linearization l_;            // scaled
  Eigen::MatrixXd constraint_; // scaled, (rows and held, all)
  ConstraintSpace space_;
  Eigen::MatrixXd basis_; // of what is held nothing, to the last bit
  Eigen::VectorXd units_; // of inertia (pencil.hpp)
  SymmetricEigen shape_;  // of the mass in these
  Cholesky factors_;      // of the mass, where nothing is without
};

} // namespace flyball
