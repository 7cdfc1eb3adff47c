#include "engine/study/least_change.hpp"

#include <Eigen/QR>

#include <vector>

namespace flyball {

Eigen::VectorXd least_change(const Eigen::MatrixXd& J, const Eigen::VectorXd& b, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper, double damping, const Eigen::VectorXd& at) {
  const Eigen::Index n = J.cols(), m = J.rows(), rows = damping > 0 ? m + n : m;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, n);
  Eigen::VectorXd target = Eigen::VectorXd::Zero(rows);
  A.topRows(m) = J;
  target.head(m) = b;
  if (damping > 0) {
    A.bottomRows(n).diagonal().setConstant(damping);
    target.tail(n) = damping * at;
  }
  const double size = A.norm();
  Eigen::VectorXd D = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Index> free;
  std::vector<bool> held(static_cast<std::size_t>(n), false);
  // Each turn holds or releases one unknown; the bound stops cycles, which rounding can make.
  for (Eigen::Index turn = 0; turn < 4 * n + 4; ++turn) {
    free.clear();
    Eigen::VectorXd rest = target;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!held[static_cast<std::size_t>(i)])
        free.push_back(i);
      else
        rest -= A.col(i) * D[i];
    }
    if (!free.empty()) {
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
      factors.setThreshold(1e-11);
      factors.compute(A(Eigen::all, free));
      const Eigen::VectorXd found = factors.solve(rest);
      D(free) = found;
    }
    // The one farthest outside is held at its bound.
    Eigen::Index worst = -1;
    double outside = 0;
    for (const Eigen::Index i : free)
      if (const double beyond = std::max(lower[i] - D[i], D[i] - upper[i]); beyond > outside) {
        outside = beyond;
        worst = i;
      }
    if (worst >= 0) {
      D[worst] = std::clamp(D[worst], lower[worst], upper[worst]);
      held[static_cast<std::size_t>(worst)] = true;
      continue;
    }
    // All are inside: one that is held and wants to come back is released.
    const Eigen::VectorXd slope = A.transpose() * (A * D - target);
    Eigen::Index back = -1;
    double steepest = 1e-12 * size * (target.norm() + size * D.norm());
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!held[static_cast<std::size_t>(i)]) continue;
      const double inward = D[i] <= lower[i] ? -slope[i] : slope[i];
      if (inward > steepest) {
        steepest = inward;
        back = i;
      }
    }
    if (back < 0) break;
    held[static_cast<std::size_t>(back)] = false;
  }
  return D.cwiseMax(lower).cwiseMin(upper);
}

} // namespace flyball
