// What each link asks for by itself in motion, about its origin: the wrench of its inertia and weight less
// what is applied to it, and its coordinates' own forces. Kept apart and not summed over the bodies beyond,
// as in a residual, because in long chains the sums would leave rounding that light links at the end feel.
#pragma once

#include "engine/dynamics/motion_solver.hpp"
#include "engine/kkt/body_stiffness.hpp"

namespace flyball {

// Of the released system; by link (moment, force).
void set_body_wrenches(const System& system, const Parameters& parameters,
                       const Kinematics<double>& kinematics, std::vector<Vec6>& out);

// Springs, stops and dampers, N m or N; by coordinate.
void set_coordinate_forces(const System& system, const MotionPoint& point, Eigen::VectorXd& out);

} // namespace flyball
