#include "engine/equilibrium/reduced_hessian.hpp"

#include <algorithm>
#include <random>

namespace flyball {

void ReducedHessian::factor(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& noise, bool symmetric) {
  const Eigen::Index n = matrix.rows();
  symmetric_ = symmetric;
  positive_ = decomposed_ = false;
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
  if (!known_) {
    matrix_.setZero();
    if (symmetric) decompose();
    null_ = static_cast<int>(n);
    return;
  }
  if (symmetric) {
    cholesky_.compute(matrix_);
    // A pivot below the threshold bounds the smallest eigenvalue from above.
    positive_ =
        cholesky_.info() == Eigen::Success && cholesky_.matrixLLT().diagonal().cwiseAbs2().minCoeff() > zero;
    if (!positive_) {
      decompose();
      null_ = static_cast<int>((eigen_.eigenvalues().array().abs() <= zero).count());
    }
    return;
  }
  orthogonal_.setThreshold(zero);
  orthogonal_.compute(matrix_);
  null_ = static_cast<int>(n - orthogonal_.rank());
}

void ReducedHessian::decompose() {
  if (decomposed_ || scale_.size() == 0) return;
  eigen_.compute(matrix_);
  decomposed_ = true;
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
  if (!symmetric_) {
    x = orthogonal_.solve(work_);
  } else if (positive_) {
    x = work_;
    cholesky_.solveInPlace(x);
  } else {
    x.setZero();
    for (Eigen::Index k = 0; k < n; ++k)
      if (const double mu = eigen_.eigenvalues()[k]; std::abs(mu) > zero)
        x += eigen_.eigenvectors().col(k) * (eigen_.eigenvectors().col(k).dot(work_) / mu);
  }
  x.array() *= scale_.array();
}

Eigen::VectorXd ReducedHessian::singular_values() const {
  if (matrix_.rows() == 0 || !matrix_.allFinite()) return {};
  if (!symmetric_) return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix_).singularValues();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix_, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseAbs();
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
      if (std::abs(eigen_.eigenvalues()[k]) <= zero)
        basis.col(c++) = scale.cwiseProduct(eigen_.eigenvectors().col(k));
    return basis;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix_, Eigen::ComputeFullV);
  for (int k = 0; k < null_; ++k)
    basis.col(k) = scale.cwiseProduct(svd.matrixV().col(n - null_ + k));
  return basis;
}

Eigen::VectorXd mixture_of(const Eigen::MatrixXd& directions) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.5, 1);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(directions.rows());
  for (Eigen::Index i = 0; i < directions.cols(); ++i)
    sum += (i % 2 == 0 ? 1 : -1) * any(random) * directions.col(i);
  return sum / sum.lpNorm<Eigen::Infinity>();
}

} // namespace flyball
