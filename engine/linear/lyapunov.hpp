// Lyapunov's equation A^T P + P A = -Q.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

// P of a matrix A (n, n) whose eigenvalues all have negative real parts, and of a symmetric positive definite
// Q: by Cayley's transform with the shift s > 0, best the geometric mean of the eigenvalues' extremes, and
// the squared Smith iteration (Smith, SIAM J. Appl. Math. 16, 1968). Nothing where it does not converge, as
// where A is not stable.
std::optional<Eigen::MatrixXd> solve_lyapunov(const Eigen::MatrixXd& a, const Eigen::MatrixXd& q,
                                              double shift);

} // namespace flyball
