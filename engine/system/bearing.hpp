// Bearings: stiffness and damping matrices between two bodies.
//
// x is how the second body stands in the first: the shift d of the bearing's point, and for matrices of six
// rows the rotation vector r of its turn, both in the bearing's axes as the first body carries them,
//
//     d = A^T R_a^T (p_b - p_a),   r = log(A^T R_a^T R_b A),   x = [d_x, d_y] or [d, r]
//
// The bearing does the virtual work -(K x + C x') . dx. For small turns that is the force -(K x + C x') on
// the second body at its point and the moment of the lower three rows; at any turn below half a one the force
// is exactly that, while the moment is J^-T of the lower rows, J^-1 = I - [r]/2 + ... being what makes r' of
// the relative angular velocity: it differs from them by |r|/2 relative. So a symmetric K has exactly the
// potential x^T K x / 2. The first body feels the opposite at the same place. A part of K that is not
// symmetric has none: it feeds whirl in one direction and takes from the other (oil whip).
//
// At half a turn r jumps. A bearing that resists turns is therefore refused where a drive turns one body
// against the other, and a motion that takes it over half a turn ends there.
#pragma once

#include "engine/mechanism/result_functions.hpp"
#include "engine/system/linearization.hpp"

#include <functional>

namespace flyball {

// x, its rates, and what the bearing asks of the second body there (world axes, N and N m).
template <class S>
struct BearingState {
  Mat3T<S> axes;                // the bearing's in the first body, world
  Vec3T<S> point;               // m, of the second body
  Eigen::Matrix<S, 6, 1> x, dx; // zero where the matrices have no entries
  Mat3T<S> turning;             // J^-1; identity for two rows
  Vec3T<S> force, moment;
};
template <class S>
BearingState<S> bearing_state(const BearingElement& element, const BearingParametersOf<S>& parameters,
                              const Kinematics<S>& kinematics);

// force_x() to couple() of what it exerts on the second body (N, N m), as measures and laws of drives ask for
// them. Instantiated for double, Dual and Extended.
template <class S>
S bearing_force(Result result, const BearingElement& element, const BearingParametersOf<S>& parameters,
                const Kinematics<S>& kinematics);
// How it changes with the coordinates of q_R, the rates of these being held, or with the rates: calls
// add(v, change) for each that moves the bearing. Zero for the size of what is nothing.
void bearing_force_rates(const System& system, const Parameters& parameters, Result result,
                         std::size_t bearing, const Kinematics<double>& kinematics, bool with_rates,
                         const std::function<void(int v, double change)>& add);
// What the sum of its terms may be in size.
double bearing_force_size(Result result, const BearingParameters& parameters,
                          const BearingState<double>& state, double reach);

// Adds what bearings ask of the coordinates.
template <class S>
void add_bearings(const System& system, const ParametersOf<S>& parameters, const Kinematics<S>& kinematics,
                  Configuration<S>& f);
// Adds the sizes of the terms.
void add_bearing_sizes(const System& system, const Parameters& parameters,
                       const Kinematics<double>& kinematics, Eigen::VectorXd& force);

// Adds the derivatives with coordinates and rates.
void add_bearing_stiffness(const System& system, const Parameters& parameters,
                           const Kinematics<double>& kinematics, const std::vector<ScrewRates>& screws,
                           Eigen::MatrixXd& stiffness);
void add_bearing_damping(const System& system, const Parameters& parameters,
                         const Kinematics<double>& kinematics, Eigen::MatrixXd& velocity);

// J, of the symmetric part of K.
double bearing_energy(const System& system, const Parameters& parameters,
                      const Kinematics<double>& kinematics);
// W: what dampers take, and what the rest of K gives.
struct BearingPowers {
  double dissipated = 0, applied = 0;
};
BearingPowers bearing_powers(const System& system, const Parameters& parameters,
                             const Kinematics<double>& kinematics);

} // namespace flyball
