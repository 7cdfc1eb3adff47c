#include "engine/kkt/constraint_space.hpp"

#include "engine/linear/interruption.hpp"

#include <algorithm>

namespace flyball {

void ConstraintSpace::factor(const Eigen::MatrixXd& jacobian, double tolerance, double least) {
  rows_ = static_cast<int>(jacobian.rows());
  n_ = static_cast<int>(jacobian.cols());
  rank_ = 0;
  work_.resize(n_);
  apply_work_.resize(n_);
  if (rows_ == 0 || n_ == 0) {
    basis_.setIdentity(n_, n_);
    return;
  }
  transposed_ = jacobian.transpose();
  if (!qr_.compute(transposed_)) {
    basis_.setIdentity(n_, n_);
    return;
  }
  rank_ = qr_.pivot(0) > least ? static_cast<int>(qr_.rank(std::max(tolerance, least / qr_.pivot(0)))) : 0;
  basis_.setZero(n_, n_ - rank_);
  basis_.bottomRows(n_ - rank_).setIdentity();
  for (int k = rank_ - 1; k >= 0; --k) {
    interruption_point();
    basis_.bottomRows(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1),
                                                        qr_.coefficient(k), apply_work_.data());
  }
}

void ConstraintSpace::dependence(int k, Eigen::VectorXd& combination, Eigen::VectorXd& left) const {
  const int column = rank_ + k;
  // J^T P = Q [R_11 R_12; 0 R_22]
  left.setZero(n_);
  auto others = left.head(rank_);
  others = qr_.matrix().col(column).head(rank_);
  qr_.matrix().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(others);
  combination.setZero(rows_);
  combination[qr_.permutation()[column]] = 1;
  for (int i = 0; i < rank_; ++i)
    combination[qr_.permutation()[i]] = -others[i];
  others.setZero();
  const int above = std::min(column + 1, n_);
  left.segment(rank_, above - rank_) = qr_.matrix().col(column).segment(rank_, above - rank_);
  qr_.apply_q(left, std::min(rows_, n_));
}

void ConstraintSpace::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& y) const {
  y.setZero(n_);
  if (rank_ == 0) return;
  // R_11^T c = (P^T rhs)_1, y = Q_1 c.
  for (int i = 0; i < rank_; ++i)
    y[i] = rhs[qr_.permutation()[i]];
  qr_.matrix()
      .topLeftCorner(rank_, rank_)
      .triangularView<Eigen::Upper>()
      .transpose()
      .solveInPlace(y.head(rank_));
  double scratch = 0;
  for (int k = rank_ - 1; k >= 0; --k)
    y.tail(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1), qr_.coefficient(k),
                                             &scratch);
}

void ConstraintSpace::multipliers(const Eigen::VectorXd& rhs, Eigen::VectorXd& lambda) const {
  lambda.setZero(rows_);
  if (rank_ == 0) return;
  work_ = rhs;
  double scratch = 0;
  for (int k = 0; k < rank_; ++k)
    work_.tail(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1), qr_.coefficient(k),
                                                 &scratch);
  qr_.matrix().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(work_.head(rank_));
  for (int i = 0; i < rank_; ++i)
    lambda[qr_.permutation()[i]] = work_[i];
}

Eigen::VectorXd ConstraintSpace::least_norm_multipliers(const Eigen::VectorXd& rhs) const {
  Eigen::VectorXd lambda;
  multipliers(rhs, lambda);
  if (rank_ == 0 || rank_ == rows_) return lambda;
  // Dependent rows: R = [R_11 R_12]; lambda is the least-norm solution of R P^T lambda = (Q^T rhs)_1.
  const Eigen::MatrixXd r = qr_.matrix().topRows(rank_).triangularView<Eigen::Upper>();
  Eigen::VectorXd permuted(rows_);
  for (int i = 0; i < rows_; ++i)
    permuted[i] = lambda[qr_.permutation()[i]];
  const auto best = least_squares(r, r * permuted);
  for (int i = 0; best && i < rows_; ++i)
    lambda[qr_.permutation()[i]] = (*best)[i];
  return lambda;
}

} // namespace flyball
