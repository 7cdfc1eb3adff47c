// The amended potential U = V - T_0 of a conservative system: V of springs, stops, gravity and constant
// forces and torques, T_0 the kinetic energy of the drives' motion alone. Its stationary points on the
// constraints are the steady states; its strict minima are stable (Routh; Choi, Park and Yoo's reference [5]
// for the open system).
//
// T_0 serves where the drives' phase is ignorable: with single drives that no free coordinate carries,
// otherwise at a steady state.
#pragma once

#include "engine/system/kinematics.hpp"

#include <cmath>

namespace flyball {

struct Potential {
  double value = 0;     // J
  double magnitude = 0; // J, sum of the terms' sizes, for the rounding error
};
// Whether two differ by no more than rounding, as the states of a family do along which nothing resists.
inline bool same_potential(const Potential& a, const Potential& b) {
  return std::abs(a.value - b.value) <= 1e-9 * (a.magnitude + b.magnitude);
}

Potential amended_potential(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                            const Kinematics<double>& kinematics);

} // namespace flyball
