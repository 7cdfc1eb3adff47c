#include "engine/linear/spectral.hpp"

#include "engine/linear/eigenvalue_lists.hpp"
#include "engine/linear/large.hpp"

#include <Eigen/Eigenvalues>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// alpha / beta of S - s T in generalised real Schur form: the diagonal of both, or blocks (2, 2) of a complex
// pair, where T is diagonal. Betas that vanish beside their alphas stand for infinite s and are left out. As
// in Eigen::GeneralizedEigenSolver, whose eigenvectors would take long to compile.
std::vector<Complex> eigenvalues_of_pairs(const Eigen::MatrixXd& s, const Eigen::MatrixXd& t) {
  std::vector<Complex> out;
  const auto add = [&](Complex alpha, double beta) {
    if (std::abs(beta) > 1e-12 * std::abs(alpha)) out.push_back(alpha / beta);
  };
  for (Eigen::Index i = 0; i < s.rows(); ++i) {
    if (i + 1 == s.rows() || s(i + 1, i) == 0) {
      add(s(i, i), t(i, i));
      continue;
    }
    const double a = t(i, i), b = t(i + 1, i + 1);
    const double half = (s(i, i) * b - s(i + 1, i + 1) * a) / 2;
    const double imaginary = std::sqrt(std::abs(half * half + s(i + 1, i) * b * (s(i, i + 1) * a)));
    const Complex alpha(s(i + 1, i + 1) * a + half, imaginary);
    add(std::conj(alpha), a * b);
    add(alpha, a * b);
    ++i;
  }
  return out;
}

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

} // namespace

std::optional<std::vector<Complex>> generalized_eigenvalues(const Eigen::MatrixXd& a,
                                                            const Eigen::MatrixXd& b, CancelFlag cancel) {
  if (cancel) return unless_interrupted(cancel, [&] { return generalized_eigenvalues(a, b); });
  if (!a.allFinite() || !b.allFinite()) return {};
  if (a.rows() == 0) return std::vector<Complex>();
  if (a.rows() >= large::from) return eigenvalues_by_inverse(a, b);
  Eigen::RealQZ<Eigen::MatrixXd> qz(a.rows());
  qz.compute(a, b, false);
  if (qz.info() != Eigen::Success) return eigenvalues_by_inverse(a, b);
  std::vector<Complex> out = eigenvalues_of_pairs(qz.matrixS(), qz.matrixT());
  if (!all_finite(out)) return eigenvalues_by_inverse(a, b);
  return out;
}

} // namespace flyball
