// The linearised motion M q'' + (C + G) q' + K q = 0 about a steady state at one phase of the drives, and
// whether it is the same at every phase. A steady state holds at every phase; the matrices need not: where a
// drive does not stand at the root, or something spans it, they can turn with it though the balance does not.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

// In the units of motion_scaling() (n = nv), the multipliers of that phase included.
struct LinearMotion {
  Eigen::MatrixXd mass, velocity, stiffness; // (n, n)
  Eigen::MatrixXd basis;                     // (n, k), orthonormal: null space of the constraints
  Eigen::VectorXd force;                     // (n), size of the terms that each balance is made of
};

// At the configuration q and the time t (s) along the drives, from their drawn angles.
LinearMotion linear_motion(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w);

// The same at the drawn phase, on the null space of the constraints: of a dense problem that is evaluated and
// factored at z in `w`, with its best multipliers.
struct ReducedMotion {
  Eigen::MatrixXd mass, velocity, stiffness; // (k, k)
  Eigen::MatrixXd basis;                     // (n, k), orthonormal
  Eigen::VectorXd unit;                      // (n), rad or m per unit of it
  Eigen::VectorXd noise;   // (k), below what size a diagonal entry of the stiffness is rounding
  Eigen::VectorXd inertia; // (k), what a diagonal entry of the mass is made of, see own_inertia()
  // Whether the angle of something that turns at a speed that is found matters (phase_stiffness.hpp): then it
  // is none of the cyclic ones.
  bool of_angles = false;
  double stiffness_terms = 0; // where speeds are found: the norm of K before the loops take their part of it
};
ReducedMotion reduced_motion(const Problem& problem, const Unknowns& z, Workspace& w);

// Of each coordinate (n) what it has of inertia by itself; `mass` (n, n) or larger. Of a ball as much as
// about any of its axes: about one of them it may have nothing but rounding.
Eigen::VectorXd own_inertia(const System& system, const Eigen::MatrixXd& mass);

// Directions on the null space `basis` (n, k) of the constraints, orthonormal, by column: of what turns at
// speeds that are found by a torque, or keeps its momentum. Along each the motion has an eigenvalue zero, of
// its phase; where momentum is kept a second, of the states with other momenta.
Eigen::MatrixXd cyclic_directions(const System& system, const Eigen::MatrixXd& basis, bool keep_momentum);

// The columns of `motion.basis` mixed so that reference^T N is the identity: then N depends on the phase only
// as far as the null space does. Nothing where the null space turned at right angles to the reference.
std::optional<Eigen::MatrixXd> basis_beside(const LinearMotion& motion, const Eigen::MatrixXd& reference);

// Whether two phases have the same M, C + G and K on the same null space, to 1e-9 of the sizes in each
// direction and what rounding makes of the angles of drives at `time` (s), the later of them.
bool same_motion(const Problem& problem, const LinearMotion& a, const LinearMotion& b, double time);

// Whether any of the times `phases` (s) differs from the drawn phase.
bool motion_varies(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                   Workspace& w);

} // namespace flyball
