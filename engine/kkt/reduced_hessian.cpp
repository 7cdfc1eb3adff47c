#include "engine/kkt/reduced_hessian.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/uniform_random.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr Eigen::Index few_to_factor = 12; // of which an orthogonal decomposition costs no more than the rest
constexpr double far_from_singular = 1e8;  // condition in the 1-norm, by its estimate

} // namespace

void ReducedHessian::factor(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& noise, bool symmetric) {
  const Eigen::Index n = matrix.rows();
  symmetric_ = symmetric;
  positive_ = decomposed_ = by_lu_ = false;
  null_ = 0;
  scale_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    // By the diagonal, but an entry of rounding alone must come out as zero, and one beside a zero diagonal
    // no larger than one; entries of definite matrices never ask for the latter.
    double size = std::max(std::abs(matrix(i, i)), noise[i] / zero);
    for (Eigen::Index j = 0; j < n; ++j)
      if (const double a = std::abs(matrix(i, j)); a > 0)
        size = std::max(size, a * (a / std::max(a, std::abs(matrix(j, j)))));
    // What feels nothing at all takes no part, or rounding elsewhere would be a force on it.
    scale_[i] = size > 1e-300 ? 1 / std::sqrt(size) : 0;
  }
  matrix_.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      matrix_(i, j) = (symmetric ? (matrix(i, j) + matrix(j, i)) / 2 : matrix(i, j)) * scale_[i] * scale_[j];
  if (n == 0) {
    positive_ = known_ = true;
    return;
  }
  known_ = matrix_.allFinite();
  if (known_ && symmetric) {
    // A pivot below the threshold bounds the smallest eigenvalue from above.
    positive_ = cholesky_.compute(matrix_) && cholesky_.smallest_pivot() > zero;
    if (positive_) return;
    known_ = decompose();
    if (known_) null_ = static_cast<int>((eigen_.values().array().abs() <= zero).count());
  } else if (known_ && n >= few_to_factor && lu_.compute(matrix_) &&
             matrix_.cwiseAbs().colwise().sum().maxCoeff() * lu_.inverse_norm() < far_from_singular) {
    by_lu_ = true;
  } else if (known_) {
    known_ = orthogonal_.compute(matrix_, zero);
    if (known_) null_ = static_cast<int>(n - orthogonal_.rank());
  }
  if (known_) return;
  matrix_.setZero();
  null_ = static_cast<int>(n);
  if (symmetric) decomposed_ = eigen_.compute(matrix_); // zero has eigenvalues
}

bool ReducedHessian::decompose() {
  if (decomposed_ || scale_.size() == 0) return true;
  decomposed_ = eigen_.compute(matrix_);
  return decomposed_;
}

void ReducedHessian::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  const Eigen::Index n = scale_.size();
  work_.resize(n);
  x.resize(n);
  if (n == 0) return;
  work_ = rhs.cwiseProduct(scale_);
  if (null_ == n) {
    x.setZero();
    return;
  }
  if (by_lu_) {
    x = lu_.solve(work_);
  } else if (!symmetric_) {
    orthogonal_.solve(work_, x);
  } else if (positive_) {
    x = work_;
    cholesky_.solve_in_place(x);
  } else {
    x.setZero();
    for (Eigen::Index k = 0; k < n; ++k)
      if (const double mu = eigen_.values()[k]; std::abs(mu) > zero)
        x += eigen_.vectors().col(k) * (eigen_.vectors().col(k).dot(work_) / mu);
  }
  x.array() *= scale_.array();
}

Eigen::VectorXd ReducedHessian::singular_values() const {
  if (matrix_.rows() == 0 || !matrix_.allFinite()) return {};
  if (!symmetric_) return flyball::singular_values(matrix_).value_or(Eigen::VectorXd());
  return symmetric_eigenvalues(matrix_).value_or(Eigen::VectorXd()).cwiseAbs();
}

double ReducedHessian::condition() const {
  const Eigen::VectorXd values = singular_values();
  if (values.size() == 0) return 1;
  // Directions that nothing resists are not solved for.
  double low = values.maxCoeff();
  for (double value : values)
    if (value > zero * values.maxCoeff()) low = std::min(low, value);
  return low > 0 ? values.maxCoeff() / low : 1;
}

Eigen::MatrixXd ReducedHessian::null_basis() const {
  const Eigen::Index n = scale_.size();
  Eigen::MatrixXd basis(n, null_);
  if (null_ == n) return Eigen::MatrixXd::Identity(n, n);
  if (null_ == 0) return basis;
  // What feels nothing at all has no scale; here it takes part as it is.
  const Eigen::VectorXd scale = (scale_.array() > 0).select(scale_, 1.);
  if (symmetric_) {
    Eigen::Index c = 0;
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::abs(eigen_.values()[k]) <= zero) basis.col(c++) = scale.cwiseProduct(eigen_.vectors().col(k));
    return basis;
  }
  if (n >= large::from) {
    const auto smallest = large::smallest_singular(matrix_, null_);
    if (!smallest) return Eigen::MatrixXd::Identity(n, n).leftCols(null_);
    return scale.asDiagonal() * smallest->right.rowwise().reverse();
  }
  const auto svd = singular_vectors(matrix_); // of finite entries, as factor() has seen to
  if (!svd) return Eigen::MatrixXd::Identity(n, n).leftCols(null_);
  for (int k = 0; k < null_; ++k)
    basis.col(k) = scale.cwiseProduct(svd->right.col(n - null_ + k));
  return basis;
}

Eigen::VectorXd mixture_of(const Eigen::MatrixXd& directions) {
  std::mt19937 random(3);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(directions.rows());
  for (Eigen::Index i = 0; i < directions.cols(); ++i)
    sum += (i % 2 == 0 ? 1 : -1) * uniform(random, 0.5, 1) * directions.col(i);
  return sum / sum.lpNorm<Eigen::Infinity>();
}

} // namespace flyball
