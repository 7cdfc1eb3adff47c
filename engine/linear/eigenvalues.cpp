#include "engine/linear/spectral.hpp"

#include "engine/linear/eigenvalue_lists.hpp"
#include "engine/linear/large.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

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

} // namespace

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

} // namespace flyball
