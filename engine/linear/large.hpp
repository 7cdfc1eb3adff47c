// Decompositions of large dense matrices in pieces of a few milliseconds, between which a flag is looked at:
// so that a computation that nobody wants any more ends at once, and not when a matrix of a thousand rows has
// been decomposed. Of small matrices Eigen's own serve (spectral.hpp, which chooses).
//
// All return false, or nothing, where `cancel` became true; what they were to fill is then of no use.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace flyball {

namespace large {

// Rows from which on a decomposition takes long enough to be worth interrupting.
inline constexpr Eigen::Index from = 150;

// a b, (m, k) times (k, n). Also for small matrices, where it costs nothing beside Eigen's product.
void multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& out);
// b^T a b of a square a (m, m) and a b (m, n). Where b is square it must be the identity, and a itself is the
// answer: the null space of no constraints at all.
Eigen::MatrixXd projected(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// a = L L^T by panels of columns (Golub and Van Loan, Matrix Computations, section 4.2.6); L comes in the
// lower triangle of `a`. False where a pivot is not above zero.
[[nodiscard]] bool factor_cholesky(Eigen::MatrixXd& a);

// P a = L U with partial pivoting, by panels (section 3.4.7). L below the diagonal of `a` with a diagonal of
// ones, U above; row i was exchanged for row exchanges[i], one after the other.
void factor_lu(Eigen::MatrixXd& a, Eigen::VectorXi& exchanges);

// a P = Q R with column pivoting (section 5.4.2), in the form of Eigen::ColPivHouseholderQR: R in the upper
// triangle of `a`, the essential parts of the Householder vectors below; column i of a P is column order[i]
// of a.
void factor_pivoted_qr(Eigen::MatrixXd& a, Eigen::VectorXd& coefficients, Eigen::VectorXi& order);

// Eigenvalues, ascending, and orthonormal eigenvectors (columns; where `vectors` is not null) of a symmetric
// matrix, whose lower triangle is read: reduction to tridiagonal form and implicit QR steps with Wilkinson's
// shift (sections 8.3.1 to 8.3.5). False where an eigenvalue takes more than 60 steps.
[[nodiscard]] bool symmetric_eigen(Eigen::MatrixXd a, Eigen::VectorXd& values, Eigen::MatrixXd* vectors);

// The `count` smallest singular values of a square matrix, ascending, and their vectors (columns): block
// inverse iteration on A^T A by the factors of A (section 8.2.4), to about eight digits where they stand
// apart from the rest. Nothing where a number is not finite.
struct SmallestSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd left, right;
  int sign = 1; // of the determinant
};
std::optional<SmallestSingular> smallest_singular(const Eigen::MatrixXd& a, Eigen::Index count);

} // namespace large
} // namespace flyball
