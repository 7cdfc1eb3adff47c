#include "engine/linear/lyapunov.hpp"

#include "engine/linear/spectral.hpp"

#include <cmath>

namespace flyball {

std::optional<Eigen::MatrixXd> solve_lyapunov(const Eigen::MatrixXd& a, const Eigen::MatrixXd& q,
                                              double shift) {
  constexpr int most_doublings = 64;
  const Eigen::Index n = a.rows();
  Lu lu;
  if (n == 0 || !lu.compute(shift * Eigen::MatrixXd::Identity(n, n) - a)) return {};
  Eigen::MatrixXd inverse(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    inverse.col(i) = lu.solve(Eigen::VectorXd::Unit(n, i));
  // P - C^T P C = 2 s (s - A)^-T Q (s - A)^-1 with C = (s + A) (s - A)^-1
  Eigen::MatrixXd c = 2 * shift * inverse - Eigen::MatrixXd::Identity(n, n),
                  p = 2 * shift * inverse.transpose() * q * inverse, more(n, n);
  for (int i = 0; i < most_doublings; ++i) {
    more.noalias() = c.transpose() * p * c;
    p += more;
    const double size = p.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return {};
    if (more.cwiseAbs().maxCoeff() <= 1e-16 * size) return Eigen::MatrixXd((p + p.transpose()) / 2);
    c = c * c;
  }
  return {};
}

} // namespace flyball
