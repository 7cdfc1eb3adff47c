// How the value that a joint labels a coordinate with changes along steps of q_R.
#pragma once

#include "engine/system/kinematics.hpp"

#include <complex>

namespace flyball {

// Gradient of coordinate_value by the entries of a step of q_R, unscaled: 1 at its own entry, and of a
// component of a rotation vector its row of the inverse Jacobian. Zero where it is driven.
Eigen::VectorXd coordinate_gradient(const System& system, const Parameters& parameters,
                                    const Eigen::VectorXd& q, const CoordinateInfo& coordinate);

// By how much the value changes along a step, unscaled.
std::complex<double> coordinate_change(const System& system, const Parameters& parameters,
                                       const Eigen::VectorXd& q, const CoordinateInfo& coordinate,
                                       const Eigen::VectorXcd& step);

// `coordinate`'s value less a wanted one, rad or m; of an angle that is the same after a whole turn (no
// spring or stop) the short way round.
double away_from(const System& system, const Parameters& parameters, const CoordinateInfo& coordinate,
                 double value, double wanted);

// The free coordinate named "joint" or "joint.index". Throws SceneError where there is none, or where it is
// driven.
const CoordinateInfo& free_coordinate(const System& system, std::string_view name);
// That of which "joint.speed" or "joint.index.speed" is the speed, which a drive by torque has; null where
// the name is another's.
const CoordinateInfo* coordinate_of_speed(const System& system, std::string_view name);

// Of a free coordinate its value and its gradient; of one that a drive by torque turns its speed (rad/s or
// m/s) and that of it. What differences are measured by: a radian, the reach, a speed as large as that where
// the search begins.
double found_value(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                   const CoordinateInfo& coordinate);
Eigen::VectorXd found_gradient(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                               const CoordinateInfo& coordinate);
double found_scale(const System& system, const Parameters& parameters, const CoordinateInfo& coordinate);

} // namespace flyball
