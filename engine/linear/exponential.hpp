#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

// exp(a) of a real matrix (n, n), by scaling and squaring of Pade approximants (Higham, The scaling and
// squaring method for the matrix exponential revisited, 2005). Nothing where an entry of a or of the result
// is not finite.
std::optional<Eigen::MatrixXd> matrix_exponential(const Eigen::MatrixXd& a);

} // namespace flyball
