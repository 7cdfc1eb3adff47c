// Every decomposition of the program, in one place and each checked: what cannot be decomposed (an entry that
// is not finite, an iteration that does not converge) is a value that the caller must handle, so that no
// result is ever read that was not computed. Instantiated once, which spares every other file the compiling.
//
// Large matrices are decomposed with interruption points on the way (large.hpp): where the flag of the thread
// is set (interruption.hpp) they throw Interrupted.
//
// The classes keep their storage: computing again at the same size allocates nothing. Their results may be
// read after a compute() that returned true, and only then.
#pragma once

#include "engine/linear/interruption.hpp"
#include <Eigen/Cholesky>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <atomic>
#include <complex>
#include <optional>
#include <vector>

namespace flyball {

// A = V diag(values) V^T of a symmetric matrix (n, n), by the symmetric QR algorithm (Golub and Van Loan,
// Matrix Computations, section 8.3). Only the lower triangle is read.
class SymmetricEigen {
 public:
  // False where there is no entry, one is not finite, or the iteration does not converge.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a, bool with_vectors = true);
  const Eigen::VectorXd& values() const { return large_ ? values_ : solver_.eigenvalues(); } // (n), ascending
  // (n, n), orthonormal columns
  const Eigen::MatrixXd& vectors() const { return large_ ? vectors_ : solver_.eigenvectors(); }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
  bool large_ = false; // then these
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_;
};

// A = L L^T of a symmetric positive definite matrix (n, n); the lower triangle is read.
class Cholesky {
 public:
  // False where the matrix is not positive definite to working precision.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a);
  // x = A^-1 x, in place; x may be a block of a longer vector.
  void solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  // L^-1 b
  Eigen::MatrixXd forward(const Eigen::MatrixXd& b) const;
  double smallest_pivot() const; // of A = L' D L'^T: L_ii^2

 private:
  Eigen::LLT<Eigen::MatrixXd> factors_;
  bool large_ = false; // then this, in the lower triangle
  Eigen::MatrixXd lower_;
};

// A P = Q R with column pivoting (m, n): |R_00| >= |R_11| >= ...; the rank is read off the diagonal of R
// (Golub and Van Loan, section 5.4).
class PivotedQr {
 public:
  // False where there is no entry or one is not finite.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a);
  Eigen::Index rank(double relative_tolerance) const; // pivots above this share of the largest
  double pivot(Eigen::Index i) const { return std::abs(matrix()(i, i)); }
  // Column i of A P is column permutation()[i] of A.
  const Eigen::PermutationMatrix<Eigen::Dynamic>::IndicesType& permutation() const {
    return large_ ? order_ : qr_.colsPermutation().indices();
  }
  // R above, Householder vectors below
  const Eigen::MatrixXd& matrix() const { return large_ ? matrix_ : qr_.matrixQR(); }
  double coefficient(Eigen::Index k) const { return large_ ? coefficients_[k] : qr_.hCoeffs()[k]; }
  Eigen::MatrixXd q() const; // (m, m)
  // x = Q x and x = Q^T x by the first `count` reflections, in place.
  void apply_q(Eigen::VectorXd& x, Eigen::Index count) const;
  void apply_q_transposed(Eigen::VectorXd& x, Eigen::Index count) const;

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  bool large_ = false; // then these
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXi order_;
};

// A = Q R without pivoting (m, n), m >= n.
class HouseholderQr {
 public:
  // False where there is no entry or one is not finite.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a);
  const Eigen::MatrixXd& matrix() const { return qr_.matrixQR(); }
  double coefficient(Eigen::Index k) const { return qr_.hCoeffs()[k]; }
  Eigen::MatrixXd q() const; // (m, m)

 private:
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
};

// Least squares of least norm for a matrix (m, n) of any rank, by a complete orthogonal decomposition (Golub
// and Van Loan, section 5.5).
class CompleteOrthogonal {
 public:
  // Pivots below this share of the largest count as zero. False where an entry is not finite.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a, std::optional<double> relative_tolerance = {});
  Eigen::Index rank() const { return rank_; }
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);

 private:
  Eigen::Index unknowns_ = 0, rank_ = 0;
  PivotedQr qr_, rows_; // A P = Q R, and where the rank is short R_1^T P' = Q' R' of its first rows
  Eigen::VectorXd right_, permuted_;
};

// A square matrix (n, n), by LU with partial pivoting.
class Lu {
 public:
  // False where an entry is not finite or a pivot is exactly zero.
  [[nodiscard]] bool compute(const Eigen::MatrixXd& a);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& b) const;
  int sign_of_determinant() const; // -1 or 1
  // Of the 1-norm of A^-1, from below and as a rule within a factor of three (Hager, Condition estimates,
  // 1984; Golub and Van Loan, section 3.5).
  double inverse_norm() const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  bool large_ = false; // then these
  Eigen::MatrixXd factors_;
  Eigen::VectorXi exchanges_;
};

// The same of a complex matrix, for blocks of right-hand sides.
class ComplexLu {
 public:
  [[nodiscard]] bool compute(const Eigen::MatrixXcd& a);
  Eigen::MatrixXcd solve(const Eigen::MatrixXcd& b) const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu_;
};

// Q (n, n), orthonormal, whose first columns span those of `columns` (n, k), k <= n.
std::optional<Eigen::MatrixXd> orthonormal_completion(const Eigen::MatrixXd& columns);

// The same of at most six columns of spatial vectors, without allocation.
using SpatialColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
Eigen::Matrix<double, 6, 6> spatial_completion(const SpatialColumns& columns);

// Basis (columns, not orthonormal) of the null space of a (m, n), by LU with complete pivoting; (n, 0) where
// the rank is full. Nothing where an entry is not finite.
std::optional<Eigen::MatrixXd> null_space(const Eigen::MatrixXd& a);

// x of least norm that minimises |a x - b|.
std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
// The same for every column of b.
std::optional<Eigen::MatrixXd> least_squares_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// x with a x = b by LU with complete pivoting, which is as good as a (nearly) singular matrix allows. Nothing
// where an entry of a, b or x is not finite.
std::optional<Eigen::VectorXd> solve_square(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

// Ascending; of a symmetric matrix, whose lower triangle is read.
std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& a);

// Descending, min(m, n) of them.
std::optional<Eigen::VectorXd> singular_values(const Eigen::MatrixXd& a);

struct SingularVectors {
  Eigen::VectorXd values;      // descending
  Eigen::MatrixXd left, right; // (m, m) and (n, n)
};
std::optional<SingularVectors> singular_vectors(const Eigen::MatrixXd& a);

// Of a general real matrix (n, n), in no particular order, by Hessenberg reduction and Francis steps (Golub
// and Van Loan, section 7.5). Nothing where an entry is not finite, the iteration does not converge or
// `cancel` is set, which large matrices look at all the time.
std::optional<std::vector<std::complex<double>>> eigenvalues(const Eigen::MatrixXd& a,
                                                             CancelFlag cancel = nullptr);

struct ComplexEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors; // columns, by value, of length one
};
std::optional<ComplexEigen> eigenvectors(const Eigen::MatrixXd& a);

// A = U T U^T of a general real matrix (n, n): U orthogonal, T upper triangular but for blocks (2, 2) of
// complex pairs (Golub and Van Loan, section 7.4).
struct SchurForm {
  Eigen::MatrixXd t, u;
};
std::optional<SchurForm> real_schur(const Eigen::MatrixXd& a);

// The finite s of (a - s b) x = 0, b singular or not: by QZ (Moler and Stewart 1973), and where that does not
// converge by shift and invert. Eigenvalues above 1e12 times the size of the rest count as infinite and are
// left out. Nothing where neither gives an answer, as of a singular pencil.
std::optional<std::vector<std::complex<double>>>
generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, CancelFlag cancel = nullptr);

// Of a symmetric matrix (3, 3); the lower triangle is read.
struct PrincipalAxes {
  Eigen::Vector3d values;  // ascending
  Eigen::Matrix3d vectors; // orthonormal columns
};
std::optional<PrincipalAxes> principal_axes(const Eigen::Matrix3d& a);

struct SingularVectors3 {
  Eigen::Vector3d values; // descending
  Eigen::Matrix3d left, right;
};
std::optional<SingularVectors3> singular_vectors_3(const Eigen::Matrix3d& a);

} // namespace flyball
