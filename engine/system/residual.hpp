// The balance of eq. 23: f = B_R^T (M B_D' q_D' - Q) + Phi_qR^T lambda and Phi, at a phase of the drives.
//
// The first part is what the recursive Newton-Euler algorithm returns for velocities [q_D'; 0] and zero
// accelerations, so B is never formed. Forces between two bodies are put on the coordinates between them
// alone, so that a stiff spring leaves no rounding on the rest of the tree.
#pragma once

#include "engine/system/kinematics.hpp"

namespace flyball {

template <class S>
struct Residual {
  Configuration<S> f;   // N m or N, by coordinate of q_R: inertia less applied plus constraint forces
  Configuration<S> phi; // m or 1, by constraint row; gears rad or m
  // By System::torques: what turning takes (N m or N), where f has the momentum instead.
  Configuration<S> taken;
  // Force and moment about the link's origin that its subtree's inertia, weight and single-body forces ask
  // for.
  std::vector<Vec3T<S>> force, moment;
  std::vector<Vec3T<S>> spine_force, spine_moment; // workspace: of each part on each link of the spine
};

// `kinematics` must be at (q, t). Instantiated for double, Extended and Dual.
template <class S>
void evaluate_residual(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q,
                       const Configuration<S>& lambda, const Kinematics<S>& kinematics, Residual<S>& out);

// Phi alone.
template <class S>
void evaluate_constraints(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q,
                          const Kinematics<S>& kinematics, Configuration<S>& phi);

// How large the terms of each equation are before they cancel, for scaling and for the rounding error of f:
// |f_i| below a few units of 1e-16 force[i] is zero as far as double can tell. Same units as f and phi.
struct Magnitudes {
  Eigen::VectorXd force, phi, taken;
  std::vector<double> link_force, link_moment; // workspace
  std::vector<double> spine_force, spine_moment, largest;
};
void evaluate_magnitudes(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& lambda, const Kinematics<double>& kinematics,
                         Magnitudes& out);

// Adds what springs and dampers between two bodies ask of the coordinates, a part of the residual's f.
void add_pair_forces(const System& system, const Parameters& parameters, const Kinematics<double>& kinematics,
                     Eigen::VectorXd& f);

// Applied on the link by a force, torque or drag: force (N) at a point, and a torque (N m).
template <class S>
struct AppliedForce {
  Vec3T<S> point, force, torque;
};
template <class S>
AppliedForce<S> applied_force(const BodyForceElement& element, const BodyForceParametersOf<S>& parameters,
                              const Kinematics<S>& kinematics);

// Tension of a point spring (N, pulling its ends together), its direction a to b, and its second end.
template <class S>
struct SpringState {
  Vec3T<S> a, b, direction;
  S length, tension;
};
template <class S>
SpringState<S> spring_state(const PointSpringElement& element, const PointSpringParametersOf<S>& parameters,
                            const Kinematics<S>& kinematics);

// How fast its length grows (m/s).
inline double stretching(const PointSpringElement& e, const SpringState<double>& s,
                         const Kinematics<double>& k) {
  return s.direction.dot(k.velocity(e.ends.b, s.b) - k.velocity(e.ends.a, s.a));
}

} // namespace flyball
