#include "engine/linear/spectral.hpp"

#include "engine/linear/large.hpp"

namespace flyball {

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

double Lu::inverse_norm() const {
  const Eigen::Index n = large_ ? factors_.rows() : lu_.rows();
  if (n == 0) return 0;
  Eigen::VectorXd x = Eigen::VectorXd::Constant(n, 1 / static_cast<double>(n));
  double norm = 0;
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd y = solve(x);
    norm = std::max(norm, y.lpNorm<1>());
    const Eigen::VectorXd z = solve_transposed(y.unaryExpr([](double v) { return v < 0 ? -1. : 1.; }));
    Eigen::Index steepest = 0;
    if (z.cwiseAbs().maxCoeff(&steepest) <= std::abs(z.dot(x))) break;
    x = Eigen::VectorXd::Unit(n, steepest);
  }
  return norm;
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

std::optional<Eigen::MatrixXd> null_space(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  if (a.size() == 0) return Eigen::MatrixXd(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
  if (lu.rank() == 0) return Eigen::MatrixXd(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
  if (lu.dimensionOfKernel() == 0) return Eigen::MatrixXd(a.cols(), 0);
  return Eigen::MatrixXd(lu.kernel());
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

} // namespace flyball
