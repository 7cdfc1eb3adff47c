// Small linear programs by an active set.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

// x with the largest g . x among those with -1 <= x_i <= 1 and lower <= A x <= upper, between which zero
// lies, to rounding. Without steps of no length it is the largest; where many constraints meet in one point
// it may be less, but never less than zero.
Eigen::VectorXd largest_within(const Eigen::VectorXd& g, const Eigen::MatrixXd& A,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

// The least t for which an x with A x = b and |x_i| <= t is found; nothing where none is, of more than some
// tens of columns, and where it is but rounding's.
std::optional<double> least_largest(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

} // namespace flyball
