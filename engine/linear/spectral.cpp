#include "engine/linear/spectral.hpp"

#include <Eigen/SVD>

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// From here on a decomposition takes a tenth of a second and more, and looks at the cancel flag as it goes.
constexpr Eigen::Index large = 150;

bool cancelled(CancelFlag cancel) {
  return cancel && cancel->load(std::memory_order_relaxed);
}

bool all_finite(const std::vector<Complex>& values) {
  return std::ranges::all_of(values,
                             [](Complex x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); });
}

// Of a quasi-triangular matrix whose blocks (2, 2) have complex eigenvalues.
std::vector<Complex> eigenvalues_of_blocks(const Eigen::MatrixXd& t) {
  std::vector<Complex> out;
  out.reserve(static_cast<std::size_t>(t.rows()));
  for (Eigen::Index i = 0; i < t.rows(); ++i) {
    if (i + 1 == t.rows() || t(i + 1, i) == 0) {
      out.emplace_back(t(i, i), 0);
      continue;
    }
    const double half = (t(i, i) - t(i + 1, i + 1)) / 2;
    const double size = std::max({std::abs(half), std::abs(t(i + 1, i)), std::abs(t(i, i + 1))});
    const double imaginary =
        size *
        std::sqrt(std::abs((half / size) * (half / size) + (t(i + 1, i) / size) * (t(i, i + 1) / size)));
    out.emplace_back(t(i + 1, i + 1) + half, imaginary);
    out.emplace_back(t(i + 1, i + 1) + half, -imaginary);
    ++i;
  }
  return out;
}

// A to upper Hessenberg form by Householder reflections, in place; false where cancelled.
bool reduce_to_hessenberg(Eigen::MatrixXd& a, CancelFlag cancel) {
  const Eigen::Index n = a.rows();
  Eigen::VectorXd work(n), essential(n);
  for (Eigen::Index k = 0; k + 2 < n; ++k) {
    if (cancelled(cancel)) return false;
    const Eigen::Index rest = n - k - 1;
    double tau = 0, beta = 0;
    auto tail = essential.head(rest - 1);
    a.col(k).tail(rest).makeHouseholder(tail, tau, beta);
    a.col(k).tail(rest).setZero();
    a(k + 1, k) = beta;
    a.bottomRightCorner(rest, rest).applyHouseholderOnTheLeft(tail, tau, work.data());
    a.rightCols(rest).applyHouseholderOnTheRight(tail, tau, work.data());
  }
  return true;
}

std::optional<std::vector<Complex>> eigenvalues_of_large(Eigen::MatrixXd a, CancelFlag cancel) {
  const double size = a.cwiseAbs().maxCoeff();
  if (size == 0) return std::vector<Complex>(static_cast<std::size_t>(a.rows()));
  a /= size;
  if (!reduce_to_hessenberg(a, cancel)) return {};
  // Francis steps in rounds, between which the flag is looked at: each leaves a matrix that is similar to the
  // first. Fewer than ten steps to a round keep clear of the exceptional shifts, which a round would forget.
  Eigen::RealSchur<Eigen::MatrixXd> schur(a.rows());
  const Eigen::Index rounds = 8 * a.rows();
  for (Eigen::Index round = 0; round < rounds; ++round) {
    if (cancelled(cancel)) return {};
    schur.setMaxIterations(round + 1 < rounds ? 9 : 40 * a.rows());
    schur.computeFromHessenberg(a, a, false);
    if (schur.info() == Eigen::Success) {
      std::vector<Complex> out = eigenvalues_of_blocks(schur.matrixT());
      for (Complex& x : out)
        x *= size;
      return out;
    }
    a = schur.matrixT();
  }
  return {};
}

// s = shift + 1 / mu, mu the eigenvalues of (a - shift b)^-1 b; a mu of rounding stands for an infinite s.
std::optional<std::vector<Complex>> eigenvalues_by_inverse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                                           CancelFlag cancel) {
  const double size = b.norm() > 0 && a.norm() > 0 ? a.norm() / b.norm() : 1;
  for (const double share : {0.137, 0.731, 0.0193}) {
    Lu lu;
    const double shift = share * size;
    if (!lu.compute(a - shift * b)) continue;
    Eigen::MatrixXd inverse(a.rows(), a.cols());
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      if (cancelled(cancel)) return {};
      inverse.col(c) = lu.solve(b.col(c));
    }
    // A nearly singular pencil has any number as eigenvalue.
    if (!inverse.allFinite() || inverse.norm() * size > 1e13) continue;
    const auto found = eigenvalues(inverse, cancel);
    if (!found) continue;
    double largest = 0;
    for (const Complex mu : *found)
      largest = std::max(largest, std::abs(mu));
    std::vector<Complex> out;
    for (const Complex mu : *found)
      if (std::abs(mu) > 1e-12 * largest) out.push_back(shift + 1. / mu);
    if (all_finite(out)) return out;
  }
  return {};
}

} // namespace

bool SymmetricEigen::compute(const Eigen::MatrixXd& a, bool with_vectors) {
  if (a.rows() == 0 || !a.allFinite()) return false;
  solver_.compute(a, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  return solver_.info() == Eigen::Success;
}

bool Cholesky::compute(const Eigen::MatrixXd& a) {
  factors_.compute(a);
  // Of NaN the comparison inside tells nothing.
  return factors_.info() == Eigen::Success &&
         (a.rows() == 0 || std::isfinite(factors_.matrixLLT().diagonal().sum()));
}

void Cholesky::solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const {
  factors_.solveInPlace(x);
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  return factors_.solve(b);
}

Eigen::MatrixXd Cholesky::forward(const Eigen::MatrixXd& b) const {
  return factors_.matrixL().solve(b);
}

double Cholesky::smallest_pivot() const {
  return factors_.matrixLLT().diagonal().cwiseAbs2().minCoeff();
}

bool PivotedQr::compute(const Eigen::MatrixXd& a) {
  if (a.size() == 0 || !a.allFinite()) return false;
  qr_.compute(a);
  return true;
}

Eigen::Index PivotedQr::rank(double relative_tolerance) const {
  const Eigen::Index limit = std::min(qr_.rows(), qr_.cols());
  Eigen::Index rank = 0;
  while (rank < limit && pivot(rank) > relative_tolerance * pivot(0) && pivot(rank) > 0)
    ++rank;
  return rank;
}

Eigen::MatrixXd PivotedQr::q() const {
  return qr_.householderQ();
}

bool HouseholderQr::compute(const Eigen::MatrixXd& a) {
  if (a.size() == 0 || !a.allFinite()) return false;
  qr_.compute(a);
  return true;
}

Eigen::MatrixXd HouseholderQr::q() const {
  return qr_.householderQ();
}

bool CompleteOrthogonal::compute(const Eigen::MatrixXd& a, std::optional<double> relative_tolerance) {
  unknowns_ = a.cols();
  empty_ = a.size() == 0;
  if (empty_) return true;
  if (!a.allFinite()) return false;
  if (relative_tolerance)
    decomposition_.setThreshold(*relative_tolerance);
  else
    decomposition_.setThreshold(Eigen::Default);
  decomposition_.compute(a);
  return true;
}

Eigen::Index CompleteOrthogonal::rank() const {
  return empty_ ? 0 : decomposition_.rank();
}

void CompleteOrthogonal::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  if (empty_)
    x.setZero(unknowns_);
  else
    x = decomposition_.solve(b);
}

Eigen::MatrixXd CompleteOrthogonal::solve(const Eigen::MatrixXd& b) const {
  if (empty_) return Eigen::MatrixXd::Zero(unknowns_, b.cols());
  return decomposition_.solve(b);
}

bool Lu::compute(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return false;
  lu_.compute(a);
  return a.rows() == 0 || lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0;
}

Eigen::VectorXd Lu::solve(const Eigen::VectorXd& b) const {
  return lu_.solve(b);
}

Eigen::VectorXd Lu::solve_transposed(const Eigen::VectorXd& b) const {
  return lu_.transpose().solve(b);
}

int Lu::sign_of_determinant() const {
  int sign = lu_.permutationP().determinant() < 0 ? -1 : 1;
  for (const double pivot : lu_.matrixLU().diagonal())
    if (pivot < 0) sign = -sign;
  return sign;
}

bool ComplexLu::compute(const Eigen::MatrixXcd& a) {
  if (!a.allFinite()) return false;
  lu_.compute(a);
  return a.rows() == 0 || lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0;
}

Eigen::MatrixXcd ComplexLu::solve(const Eigen::MatrixXcd& b) const {
  return lu_.solve(b);
}

std::optional<Eigen::MatrixXd> orthonormal_completion(const Eigen::MatrixXd& columns) {
  HouseholderQr qr;
  if (columns.cols() > columns.rows() || !qr.compute(columns)) return {};
  return qr.q();
}

Eigen::Matrix<double, 6, 6> spatial_completion(const SpatialColumns& columns) {
  const Eigen::HouseholderQR<SpatialColumns> qr(columns);
  return qr.householderQ() * Eigen::Matrix<double, 6, 6>::Identity();
}

std::optional<Eigen::MatrixXd> null_space(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.size() == 0) return Eigen::MatrixXd(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
  if (lu.rank() == 0) return Eigen::MatrixXd(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
  if (lu.dimensionOfKernel() == 0) return Eigen::MatrixXd(a.cols(), 0);
  return Eigen::MatrixXd(lu.kernel());
}

std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  CompleteOrthogonal decomposition;
  if (!decomposition.compute(a)) return {};
  Eigen::VectorXd x;
  decomposition.solve(b, x);
  if (!x.allFinite()) return {};
  return x;
}

std::optional<Eigen::MatrixXd> least_squares_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  CompleteOrthogonal decomposition;
  if (!decomposition.compute(a)) return {};
  Eigen::MatrixXd x = decomposition.solve(b);
  if (!x.allFinite()) return {};
  return x;
}

std::optional<Eigen::VectorXd> solve_square(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (a.rows() == 0) return Eigen::VectorXd(0);
  if (!a.allFinite() || !b.allFinite()) return {};
  Eigen::VectorXd x = Eigen::FullPivLU<Eigen::MatrixXd>(a).solve(b);
  if (!x.allFinite()) return {};
  return x;
}

std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  SymmetricEigen eigen;
  if (a.rows() == 0) return Eigen::VectorXd(0);
  if (!eigen.compute(a, false)) return {};
  return eigen.values();
}

std::optional<Eigen::VectorXd> singular_values(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.size() == 0) return Eigen::VectorXd(0);
  // One-sided Jacobi is the more accurate one, and too slow for large matrices.
  if (std::min(a.rows(), a.cols()) < 32) return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(a);
  if (svd.info() != Eigen::Success || !svd.singularValues().allFinite()) return {};
  return svd.singularValues();
}

std::optional<SingularVectors> singular_vectors(const Eigen::MatrixXd& a) {
  if (!a.allFinite() || a.size() == 0) return {};
  constexpr unsigned vectors = Eigen::ComputeFullU | Eigen::ComputeFullV;
  const auto result = [](const auto& svd) {
    return SingularVectors{svd.singularValues(), svd.matrixU(), svd.matrixV()};
  };
  if (std::min(a.rows(), a.cols()) < 32) return result(Eigen::JacobiSVD<Eigen::MatrixXd>(a, vectors));
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(a, vectors);
  if (svd.info() != Eigen::Success || !svd.singularValues().allFinite()) return {};
  return result(svd);
}

std::optional<std::vector<Complex>> eigenvalues(const Eigen::MatrixXd& a, CancelFlag cancel) {
  if (!a.allFinite()) return {};
  if (a.rows() == 0) return std::vector<Complex>();
  if (a.rows() >= large) return eigenvalues_of_large(a, cancel);
  Eigen::EigenSolver<Eigen::MatrixXd> eigen(a.rows());
  eigen.compute(a, false);
  // The transposed matrix has the same eigenvalues, and takes another way to them.
  if (eigen.info() != Eigen::Success) eigen.compute(a.transpose(), false);
  if (eigen.info() != Eigen::Success) return {};
  std::vector<Complex> out(eigen.eigenvalues().begin(), eigen.eigenvalues().end());
  if (!all_finite(out)) return {};
  return out;
}

std::optional<ComplexEigen> eigenvectors(const Eigen::MatrixXd& a) {
  if (!a.allFinite() || a.rows() == 0) return {};
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(a);
  if (eigen.info() != Eigen::Success) return {};
  ComplexEigen out{eigen.eigenvalues(), eigen.eigenvectors()};
  if (!out.values.allFinite() || !out.vectors.allFinite()) return {};
  return out;
}

std::optional<std::vector<Complex>> generalized_eigenvalues(const Eigen::MatrixXd& a,
                                                            const Eigen::MatrixXd& b, CancelFlag cancel) {
  if (!a.allFinite() || !b.allFinite()) return {};
  if (a.rows() == 0) return std::vector<Complex>();
  if (a.rows() >= large) return eigenvalues_by_inverse(a, b, cancel);
  Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> eigen(a.rows());
  eigen.compute(a, b, false);
  if (eigen.info() != Eigen::Success) return eigenvalues_by_inverse(a, b, cancel);
  std::vector<Complex> out;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    if (std::abs(eigen.betas()[i]) > 1e-12 * std::abs(eigen.alphas()[i]))
      out.push_back(eigen.alphas()[i] / eigen.betas()[i]);
  if (!all_finite(out)) return eigenvalues_by_inverse(a, b, cancel);
  return out;
}

std::optional<PrincipalAxes> principal_axes(const Eigen::Matrix3d& a) {
  if (!a.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(a);
  if (eigen.info() != Eigen::Success) return {};
  return PrincipalAxes{eigen.eigenvalues(), eigen.eigenvectors()};
}

std::optional<SingularVectors3> singular_vectors_3(const Eigen::Matrix3d& a) {
  if (!a.allFinite()) return {};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return SingularVectors3{svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

} // namespace flyball
