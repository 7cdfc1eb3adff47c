// Drives left to themselves. Nothing acts along the coordinate of one, so that its momentum, of all that it
// carries, stays what the given speed makes of it in the drawn pose. Its speed w is an entry of q_R as that
// of a drive by torque (drive_torque.hpp), and its row of the balance is
//
//     f_w = p(w, q_R) - p(drawn) = 0,    p = S . h:  S its axis, h the momenta of what hangs from it
//
// p = dT/dq' of the coordinate: it counts the rates of the drives that carry it and that it carries. A state
// in which something does act along the coordinate is none: see check_existence().
#pragma once

#include "engine/system/linearization.hpp"

namespace flyball {

bool keeps_momentum(const System& system);

// In the drawn pose, drives turning as they are given, all else at rest (kg m^2/s or kg m/s).
template <class N>
N drawn_momentum(const System& system, const BasicParameters<N>& parameters, int link);

// Puts these rows in the place of what turning takes, which goes to `taken`.
template <class S>
void set_kept_momenta(const System& system, const ParametersOf<S>& parameters,
                      const Kinematics<S>& kinematics, Residual<S>& out);

// The same for the sizes of the terms.
void set_kept_momentum_sizes(const System& system, const Parameters& parameters,
                             const Kinematics<double>& kinematics, Magnitudes& out);

// Their derivatives, after all others.
void set_kept_momentum_stiffness(const System& system, const Parameters& parameters,
                                 const Kinematics<double>& kinematics, Linearization& out);

} // namespace flyball
