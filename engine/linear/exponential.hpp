#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

// exp(a) of a real matrix (n, n), by scaling and squaring of Pade approximants (Higham, The scaling and
// squaring method for the matrix exponential revisited, 2005). Nothing where an entry of a or of the result
// is not finite.
std::optional<Eigen::MatrixXd> matrix_exponential(const Eigen::MatrixXd& a);

// S = -S^T with exp(S) = q of an orthogonal matrix (n, n), the shortest: no angle above pi. Nothing where the
// determinant is -1: no rotation leads there.
std::optional<Eigen::MatrixXd> rotation_logarithm(const Eigen::MatrixXd& q);

} // namespace flyball
