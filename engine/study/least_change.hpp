// Linear least squares within bounds, and of all solutions the one of least change.
#pragma once

#include <Eigen/Core>

namespace flyball {

// The D that minimises |J D - b|^2 + damping^2 |D - at|^2 within lower <= D <= upper, and without damping
// where several do the shortest. J: (equations, unknowns). By an active set as of Stark and Parker
// (Bounded-variable least squares, Computational Statistics 10, 1995), begun with all unknowns free.
Eigen::VectorXd least_change(const Eigen::MatrixXd& J, const Eigen::VectorXd& b, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper, double damping, const Eigen::VectorXd& at);

} // namespace flyball
