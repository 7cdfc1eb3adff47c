// Exact derivatives of the balance: f_z of eq. 21, and mass and velocity matrices of the motion about a
// steady state.
//
// Derivation. Perturbing coordinate j moves everything beyond it by the screw S_j, which itself is carried by
// the parent body (velocity V, acceleration A): Psi' = V x S_j, Psi'' = A x S_j + V x Psi'. A rigid body's
// force F = I A + V x* I V then changes by S_j x* F + I Psi'' + B Psi' with B x = -I (V x x) + x x* I V + V
// x* I x, and by B S_j + 2 I Psi' per unit of velocity. Sums over a subtree of I, B and F give every entry
// (the form found by Echeandia and Wensing, Numerical methods to compute the Coriolis matrix and Christoffel
// symbols, 2021). About any point B is [B_1 0; -2 [h] 0], h the linear momentum.
#pragma once

#include "engine/system/residual.hpp"

namespace flyball {

struct CompositeBody {
  double mass;       // kg
  Vec3 first_moment; // kg m, about the link's origin
  Mat3 inertia;      // kg m^2, about the link's origin
  Mat3 b;            // kg m^2/s, B_1
  Vec3 momentum;     // kg m/s
};

// About the link's origin (N m and N, or of momenta).
struct LinearizedWrench {
  Vec3 moment, force;
};
LinearizedWrench times_inertia(const CompositeBody& body, const Vec3& w, const Vec3& v);

// S, Psi' and Psi'' of one coordinate, about its link's origin: angular and linear parts.
struct ScrewRates {
  Vec3 sw, sv, dw, dv, ddw, ddv;
};

// Of coordinate v of q_R, which belongs to this link.
ScrewRates screw_rates(const System& system, const Parameters& parameters,
                       const Kinematics<double>& kinematics, int link, int v);

struct Linearization {
  Eigen::MatrixXd stiffness;  // d f / d q_R at fixed lambda: (nv, nv), rows f
  Eigen::MatrixXd constraint; // Phi_qR: (rows, nv)
  Eigen::MatrixXd mass;       // (nv, nv)
  Eigen::MatrixXd velocity;   // d f / d q_R': gyroscopic and damping, (nv, nv)
  std::vector<CompositeBody> composites;
  std::vector<ScrewRates> screws;
  std::vector<Vec3> spins; // kg m^2/s: workspace of kept_momentum.hpp
};

// Hessian of a spherical link's springs and stops in the step's axes (N m per rad).
Mat3 rotation_stiffness(const Link& link, const LinkParameters& parameters, const Eigen::VectorXd& q);

// The same of its dampers with the rates (N m s per rad).
Mat3 rotation_damping(const Link& link, const LinkParameters& parameters, const Eigen::VectorXd& q);

// Fills `constraint` alone.
void linearize_constraints(const System& system, const Parameters& parameters,
                           const Kinematics<double>& kinematics, Linearization& out);

// Fills `stiffness` and `constraint`; with the columns of drive_torque.hpp where speeds are among the
// unknowns, for which it uses `velocity`. `residual` must be evaluated at the same state. For a spherical
// link the stiffness is the derivative of the moment in fixed axes along exp(step) D; it is symmetric for
// conservative systems up to terms that vanish with the moment.
void linearize(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
               const Eigen::VectorXd& lambda, const Kinematics<double>& kinematics,
               const Residual<double>& residual, Linearization& out);

// Fills `mass` and `velocity`; call after linearize at the same state. What torques drive is a coordinate
// like others here.
void linearize_motion(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                      const Kinematics<double>& kinematics, Linearization& out);

// How fast a coordinate's damper resists more as its rate grows (N m s/rad or N s/m), for links of one axis.
double coordinate_damping(const System& system, const Parameters& parameters, int link,
                          const Kinematics<double>& kinematics);

// Adds the derivative of all damping and drag forces with the velocities; symmetric and positive
// semidefinite.
void add_damping(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                 const Kinematics<double>& kinematics, Eigen::MatrixXd& velocity);

} // namespace flyball
