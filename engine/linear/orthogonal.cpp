#include "engine/linear/spectral.hpp"

#include "engine/linear/large.hpp"

namespace flyball {

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
  rank_ = 0;
  if (a.size() == 0) return true;
  if (!qr_.compute(a)) return false;
  const double epsilon = std::numeric_limits<double>::epsilon();
  rank_ = qr_.rank(relative_tolerance.value_or(epsilon * static_cast<double>(std::min(a.rows(), a.cols()))));
  if (rank_ == unknowns_ || rank_ == 0) return true;
  const Eigen::MatrixXd r = qr_.matrix().topRows(rank_).triangularView<Eigen::Upper>();
  return rows_.compute(r.transpose());
}

void CompleteOrthogonal::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  right_ = b;
  x.setZero(unknowns_);
  if (rank_ == 0) return;
  qr_.apply_q_transposed(right_, rank_);
  permuted_.setZero(unknowns_);
  auto head = permuted_.head(rank_);
  if (rank_ == unknowns_) {
    head = right_.head(rank_);
    qr_.matrix().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(head);
  } else { // R_1 y = c is R'^T (Q'^T y) = P'^T c
    for (Eigen::Index i = 0; i < rank_; ++i)
      head[i] = right_[rows_.permutation()[i]];
    const auto transposed = rows_.matrix().topLeftCorner(rank_, rank_).transpose();
    transposed.triangularView<Eigen::Lower>().solveInPlace(head);
    rows_.apply_q(permuted_, rank_);
  }
  for (Eigen::Index i = 0; i < unknowns_; ++i)
    x[qr_.permutation()[i]] = permuted_[i];
}

Eigen::MatrixXd CompleteOrthogonal::solve(const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(unknowns_, b.cols());
  Eigen::VectorXd x;
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    interruption_point();
    solve(b.col(j), x);
    out.col(j) = x;
  }
  return out;
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

} // namespace flyball
