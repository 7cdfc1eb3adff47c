#include "engine/linear/spectral.hpp"

#include "engine/linear/large.hpp"

#include <Eigen/SVD>

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

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

// A to upper Hessenberg form by Householder reflections, in place.
void reduce_to_hessenberg(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  Eigen::VectorXd work(n), essential(n);
  for (Eigen::Index k = 0; k + 2 < n; ++k) {
    interruption_point();
    const Eigen::Index rest = n - k - 1;
    double tau = 0, beta = 0;
    auto tail = essential.head(rest - 1);
    a.col(k).tail(rest).makeHouseholder(tail, tau, beta);
    a.col(k).tail(rest).setZero();
    a(k + 1, k) = beta;
    a.bottomRightCorner(rest, rest).applyHouseholderOnTheLeft(tail, tau, work.data());
    a.rightCols(rest).applyHouseholderOnTheRight(tail, tau, work.data());
  }
}

std::optional<std::vector<Complex>> eigenvalues_of_large(Eigen::MatrixXd a) {
  const double size = a.cwiseAbs().maxCoeff();
  if (size == 0) return std::vector<Complex>(static_cast<std::size_t>(a.rows()));
  a /= size;
  reduce_to_hessenberg(a);
  // Francis steps in rounds with an interruption point between them: each leaves a matrix that is similar to
  // the first. Fewer than ten steps to a round keep clear of the exceptional shifts, which a round would
  // forget; of very large matrices one step takes long enough.
  const double entries = static_cast<double>(a.rows()) * static_cast<double>(a.rows());
  const auto at_once = static_cast<Eigen::Index>(std::clamp(2e6 / entries, 1., 9.));
  Eigen::RealSchur<Eigen::MatrixXd> schur(a.rows());
  const Eigen::Index rounds = 40 * a.rows() / at_once;
  for (Eigen::Index round = 0; round < rounds; ++round) {
    interruption_point();
    schur.setMaxIterations(round + 1 < rounds ? at_once : 40 * a.rows());
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

// Whether QZ converged may not be asked of Eigen's class where it did not: its info() asserts that it did.
class GeneralizedEigen : public Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> {
 public:
  using GeneralizedEigenSolver::GeneralizedEigenSolver;
  bool converged() const { return m_valuesOkay && m_realQZ.info() == Eigen::Success; }
};

// s = shift + 1 / mu, mu the eigenvalues of (a - shift b)^-1 b; a mu of rounding stands for an infinite s.
std::optional<std::vector<Complex>> eigenvalues_by_inverse(const Eigen::MatrixXd& a,
                                                           const Eigen::MatrixXd& b) {
  const double size = b.norm() > 0 && a.norm() > 0 ? a.norm() / b.norm() : 1;
  for (const double share : {0.137, 0.731, 0.0193}) {
    Lu lu;
    const double shift = share * size;
    if (!lu.compute(a - shift * b)) continue;
    Eigen::MatrixXd inverse(a.rows(), a.cols());
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      interruption_point();
      inverse.col(c) = lu.solve(b.col(c));
    }
    // A nearly singular pencil has any number as eigenvalue.
    if (!inverse.allFinite() || inverse.norm() * size > 1e13) continue;
    const auto found = eigenvalues(inverse);
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

// What `compute` returns, or nothing where the flag is set meanwhile.
template <class Compute>
auto unless_interrupted(CancelFlag cancel, const Compute& compute) -> decltype(compute()) {
  const Interruptible scope(cancel);
  try {
    return compute();
  } catch (const Interrupted&) {
    return {};
  }
}

} // namespace

bool SymmetricEigen::compute(const Eigen::MatrixXd& a, bool with_vectors) {
  if (!a.allFinite()) return false;
  large_ = a.rows() >= large::from;
  if (large_) return large::symmetric_eigen(a, values_, with_vectors ? &vectors_ : nullptr);
  solver_.compute(a, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  return solver_.info() == Eigen::Success;
}

bool Cholesky::compute(const Eigen::MatrixXd& a) {
  large_ = a.rows() >= large::from;
  if (large_) {
    lower_ = a;
    return large::factor_cholesky(lower_);
  }
  factors_.compute(a);
  // Of NaN the comparison inside tells nothing.
  return factors_.info() == Eigen::Success &&
         (a.rows() == 0 || std::isfinite(factors_.matrixLLT().diagonal().sum()));
}

void Cholesky::solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const {
  if (!large_) {
    factors_.solveInPlace(x);
    return;
  }
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  if (!large_) return factors_.solve(b);
  Eigen::MatrixXd x = b;
  for (auto column : x.colwise()) {
    interruption_point();
    lower_.triangularView<Eigen::Lower>().solveInPlace(column);
    lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(column);
  }
  return x;
}

Eigen::MatrixXd Cholesky::forward(const Eigen::MatrixXd& b) const {
  if (!large_) return factors_.matrixL().solve(b);
  Eigen::MatrixXd x = b;
  constexpr Eigen::Index some = 8; // columns
  for (Eigen::Index j = 0; j < x.cols(); j += some) {
    interruption_point();
    auto columns = x.middleCols(j, std::min(some, x.cols() - j));
    lower_.triangularView<Eigen::Lower>().solveInPlace(columns);
  }
  return x;
}

double Cholesky::smallest_pivot() const {
  return (large_ ? lower_ : factors_.matrixLLT()).diagonal().cwiseAbs2().minCoeff();
}

bool PivotedQr::compute(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return false;
  large_ = std::min(a.rows(), a.cols()) >= large::from;
  if (large_) {
    matrix_ = a;
    large::factor_pivoted_qr(matrix_, coefficients_, order_);
  } else {
    qr_.compute(a);
  }
  return true;
}

Eigen::Index PivotedQr::rank(double relative_tolerance) const {
  const Eigen::Index limit = std::min(matrix().rows(), matrix().cols());
  Eigen::Index rank = 0;
  while (rank < limit && pivot(rank) > relative_tolerance * pivot(0) && pivot(rank) > 0)
    ++rank;
  return rank;
}

Eigen::MatrixXd PivotedQr::q() const {
  if (!large_) return qr_.householderQ();
  Eigen::MatrixXd q = Eigen::MatrixXd::Identity(matrix_.rows(), matrix_.rows());
  Eigen::VectorXd work(q.cols());
  for (Eigen::Index k = coefficients_.size() - 1; k >= 0; --k) {
    interruption_point();
    const Eigen::Index rest = q.rows() - k;
    q.bottomRightCorner(rest, rest)
        .applyHouseholderOnTheLeft(matrix_.col(k).tail(rest - 1), coefficients_[k], work.data());
  }
  return q;
}

void PivotedQr::apply_q(Eigen::VectorXd& x, Eigen::Index count) const {
  double scratch = 0;
  for (Eigen::Index k = count - 1; k >= 0; --k)
    x.tail(x.size() - k)
        .applyHouseholderOnTheLeft(matrix().col(k).tail(x.size() - k - 1), coefficient(k), &scratch);
}

void PivotedQr::apply_q_transposed(Eigen::VectorXd& x, Eigen::Index count) const {
  double scratch = 0;
  for (Eigen::Index k = 0; k < count; ++k)
    x.tail(x.size() - k)
        .applyHouseholderOnTheLeft(matrix().col(k).tail(x.size() - k - 1), coefficient(k), &scratch);
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
  large_ = std::min(a.rows(), a.cols()) >= large::from;
  if (large_) return compute_large(a, relative_tolerance);
  if (relative_tolerance)
    decomposition_.setThreshold(*relative_tolerance);
  else
    decomposition_.setThreshold(Eigen::Default);
  decomposition_.compute(a);
  return true;
}

Eigen::Index CompleteOrthogonal::rank() const {
  return empty_ ? 0 : large_ ? rank_ : decomposition_.rank();
}

void CompleteOrthogonal::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  if (empty_)
    x.setZero(unknowns_);
  else if (large_)
    solve_large(b, x);
  else
    x = decomposition_.solve(b);
}

Eigen::MatrixXd CompleteOrthogonal::solve(const Eigen::MatrixXd& b) const {
  if (empty_) return Eigen::MatrixXd::Zero(unknowns_, b.cols());
  if (!large_) return decomposition_.solve(b);
  Eigen::MatrixXd out(unknowns_, b.cols());
  Eigen::VectorXd x;
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    interruption_point();
    solve_large(b.col(j), x);
    out.col(j) = x;
  }
  return out;
}

bool CompleteOrthogonal::compute_large(const Eigen::MatrixXd& a, std::optional<double> relative_tolerance) {
  if (!qr_.compute(a)) return false;
  const double epsilon = std::numeric_limits<double>::epsilon();
  rank_ = qr_.rank(relative_tolerance.value_or(epsilon * static_cast<double>(std::min(a.rows(), a.cols()))));
  if (rank_ == unknowns_) return true;
  const Eigen::MatrixXd r = qr_.matrix().topRows(rank_).triangularView<Eigen::Upper>();
  return rows_.compute(r.transpose());
}

void CompleteOrthogonal::solve_large(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Eigen::VectorXd right = b;
  qr_.apply_q_transposed(right, rank_);
  Eigen::VectorXd permuted = Eigen::VectorXd::Zero(unknowns_);
  auto head = permuted.head(rank_);
  if (rank_ == unknowns_) {
    head = right.head(rank_);
    qr_.matrix().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(head);
  } else if (rank_ > 0) { // R_1 y = c is R'^T (Q'^T y) = P'^T c
    for (Eigen::Index i = 0; i < rank_; ++i)
      head[i] = right[rows_.permutation()[i]];
    const auto transposed = rows_.matrix().topLeftCorner(rank_, rank_).transpose();
    transposed.triangularView<Eigen::Lower>().solveInPlace(head);
    rows_.apply_q(permuted, rank_);
  }
  x.resize(unknowns_);
  for (Eigen::Index i = 0; i < unknowns_; ++i)
    x[qr_.permutation()[i]] = permuted[i];
}

bool Lu::compute(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return false;
  large_ = a.rows() >= large::from;
  if (large_) {
    factors_ = a;
    large::factor_lu(factors_, exchanges_);
    return factors_.diagonal().cwiseAbs().minCoeff() > 0 && factors_.allFinite();
  }
  lu_.compute(a);
  return a.rows() == 0 || lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0;
}

Eigen::VectorXd Lu::solve(const Eigen::VectorXd& b) const {
  if (!large_) return lu_.solve(b);
  Eigen::VectorXd x = b;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    std::swap(x[i], x[exchanges_[i]]);
  factors_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  factors_.triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

Eigen::VectorXd Lu::solve_transposed(const Eigen::VectorXd& b) const {
  if (!large_) return lu_.transpose().solve(b);
  Eigen::VectorXd x = b;
  const auto transposed = factors_.transpose();
  transposed.triangularView<Eigen::Lower>().solveInPlace(x);
  transposed.triangularView<Eigen::UnitUpper>().solveInPlace(x);
  for (Eigen::Index i = x.size() - 1; i >= 0; --i)
    std::swap(x[i], x[exchanges_[i]]);
  return x;
}

int Lu::sign_of_determinant() const {
  int sign = 1;
  if (large_) {
    for (Eigen::Index i = 0; i < exchanges_.size(); ++i)
      if (exchanges_[i] != i) sign = -sign;
  } else if (lu_.permutationP().determinant() < 0) {
    sign = -1;
  }
  for (const double pivot : (large_ ? factors_ : lu_.matrixLU()).diagonal())
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
  // Complete pivoting of large matrices takes seconds; partial pivoting does where no pivot vanishes.
  Lu lu;
  const bool partial = a.rows() >= large::from && lu.compute(a);
  Eigen::VectorXd x = partial ? lu.solve(b) : Eigen::FullPivLU<Eigen::MatrixXd>(a).solve(b).eval();
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
  if (cancel) return unless_interrupted(cancel, [&] { return eigenvalues(a); });
  if (!a.allFinite()) return {};
  if (a.rows() == 0) return std::vector<Complex>();
  if (a.rows() >= large::from) return eigenvalues_of_large(a);
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

std::optional<SchurForm> real_schur(const Eigen::MatrixXd& a) {
  if (!a.allFinite() || a.rows() == 0) return {};
  const Eigen::RealSchur<Eigen::MatrixXd> schur(a);
  if (schur.info() != Eigen::Success) return {};
  SchurForm out{schur.matrixT(), schur.matrixU()};
  if (!out.t.allFinite() || !out.u.allFinite()) return {};
  return out;
}

std::optional<std::vector<Complex>> generalized_eigenvalues(const Eigen::MatrixXd& a,
                                                            const Eigen::MatrixXd& b, CancelFlag cancel) {
  if (cancel) return unless_interrupted(cancel, [&] { return generalized_eigenvalues(a, b); });
  if (!a.allFinite() || !b.allFinite()) return {};
  if (a.rows() == 0) return std::vector<Complex>();
  if (a.rows() >= large::from) return eigenvalues_by_inverse(a, b);
  GeneralizedEigen eigen(a.rows());
  eigen.compute(a, b, false);
  if (!eigen.converged()) return eigenvalues_by_inverse(a, b);
  std::vector<Complex> out;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    if (std::abs(eigen.betas()[i]) > 1e-12 * std::abs(eigen.alphas()[i]))
      out.push_back(eigen.alphas()[i] / eigen.betas()[i]);
  if (!all_finite(out)) return eigenvalues_by_inverse(a, b);
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
