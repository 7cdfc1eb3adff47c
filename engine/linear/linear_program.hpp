// Small linear programs by an active set.
#pragma once

#include <Eigen/Core>

namespace flyball {

// x with the largest g . x among those with -1 <= x_i <= 1 and lower <= A x <= upper, between which zero
// lies, to rounding. Without steps of no length it is the largest; where many constraints meet in one point
// it may be less, but never less than zero.
Eigen::VectorXd largest_within(const Eigen::VectorXd& g, const Eigen::MatrixXd& A,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

} // namespace flyball
