#include "engine/dynamics/saddle_point.hpp"

namespace flyball {

bool SaddlePoint::factor_constraints(const Eigen::MatrixXd& c) {
  rows_ = c.rows();
  n_ = c.cols();
  independence_ = 1;
  work_.resize(n_);
  if (rows_ == 0) return true;
  if (rows_ > n_) return false;
  transposed_ = c.transpose();
  independence_ = 0;
  if (!qr_.compute(transposed_)) return false;
  const auto pivots = qr_.matrix().diagonal().cwiseAbs();
  independence_ = pivots.minCoeff() / pivots.maxCoeff();
  return independence_ > 1e-12; // and not NaN
}

bool SaddlePoint::factor_mass(const Eigen::MatrixXd& m) {
  if (rows_ == 0) return cholesky_.compute(m);
  // Q^T M Q: the first rows are the directions that the constraints hold.
  turned_ = m;
  for (Eigen::Index k = 0; k < rows_; ++k) {
    const auto v = qr_.matrix().col(k).tail(n_ - k - 1);
    turned_.bottomRows(n_ - k).applyHouseholderOnTheLeft(v, qr_.coefficient(k), work_.data());
    turned_.rightCols(n_ - k).applyHouseholderOnTheRight(v, qr_.coefficient(k), work_.data());
  }
  free_ = turned_.bottomRightCorner(n_ - rows_, n_ - rows_);
  return cholesky_.compute(free_);
}

void SaddlePoint::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& a,
                        Eigen::VectorXd& l) {
  if (rows_ == 0) {
    a = f;
    cholesky_.solve_in_place(a);
    l.resize(0);
    return;
  }
  double scratch = 0;
  force_ = f;
  for (Eigen::Index k = 0; k < rows_; ++k)
    force_.tail(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1), qr_.coefficient(k),
                                                  &scratch);
  const auto r = qr_.matrix().topLeftCorner(rows_, rows_).triangularView<Eigen::Upper>();
  a.resize(n_);
  a.head(rows_) = g;
  r.transpose().solveInPlace(a.head(rows_));
  a.tail(n_ - rows_) = force_.tail(n_ - rows_);
  a.tail(n_ - rows_).noalias() -= turned_.bottomLeftCorner(n_ - rows_, rows_) * a.head(rows_);
  auto rest = a.tail(n_ - rows_);
  cholesky_.solve_in_place(rest);
  l = force_.head(rows_);
  l.noalias() -= turned_.topRows(rows_) * a;
  r.solveInPlace(l);
  for (Eigen::Index k = rows_; k-- > 0;)
    a.tail(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1), qr_.coefficient(k),
                                             &scratch);
}

void SaddlePoint::respond(Eigen::MatrixXd& forces) const {
  Eigen::VectorXd scratch(forces.cols());
  const auto turn = [&](Eigen::Index k) {
    forces.bottomRows(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1),
                                                        qr_.coefficient(k), scratch.data());
  };
  for (Eigen::Index k = 0; k < rows_; ++k)
    turn(k);
  forces.topRows(rows_).setZero();
  if (n_ > rows_) forces.bottomRows(n_ - rows_) = cholesky_.solve(forces.bottomRows(n_ - rows_));
  for (Eigen::Index k = rows_; k-- > 0;)
    turn(k);
}

void SaddlePoint::shortest(const Eigen::VectorXd& g, Eigen::VectorXd& a) {
  a.setZero(n_);
  if (rows_ == 0) return;
  a.head(rows_) = g;
  qr_.matrix()
      .topLeftCorner(rows_, rows_)
      .triangularView<Eigen::Upper>()
      .transpose()
      .solveInPlace(a.head(rows_));
  double scratch = 0;
  for (Eigen::Index k = rows_; k-- > 0;)
    a.tail(n_ - k).applyHouseholderOnTheLeft(qr_.matrix().col(k).tail(n_ - k - 1), qr_.coefficient(k),
                                             &scratch);
}

} // namespace flyball
