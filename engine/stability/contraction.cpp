#include "engine/stability/contraction.hpp"

#include "engine/linear/lyapunov.hpp"
#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

std::optional<double> contraction(const PeriodicMotion& motion, double fastest, double slowest,
                                  const std::atomic<bool>* cancel) {
  const Eigen::Index n = motion.size(), phases = std::max<Eigen::Index>(32, 4 * motion.harmonics());
  const double shift = std::sqrt(fastest * slowest), step = motion.period() / static_cast<double>(phases),
               beside = step / 100; // of differences: their error is far below what is left over
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd a, before, after;
  double sum = 0;
  for (Eigen::Index i = 0; i < phases; ++i) {
    if (cancel && cancel->load(std::memory_order_relaxed)) return {};
    const double time = static_cast<double>(i) * step;
    if (!motion.state_matrix(time, a) || !motion.state_matrix(time - beside, before) ||
        !motion.state_matrix(time + beside, after))
      return {};
    const Eigen::MatrixXd rate = (after - before) / (2 * beside);
    const auto p = solve_lyapunov(a, identity, shift);
    if (!p) return {};
    // P' = P_1 - P_2 with A^T P' + P' A = -(A'^T P + P A'), which is neither positive nor negative.
    const Eigen::MatrixXd turning = rate.transpose() * *p + *p * rate;
    const double size = turning.norm();
    const auto more = solve_lyapunov(a, Eigen::MatrixXd(turning + size * identity), shift);
    if (!more) return {};
    const Eigen::MatrixXd changes = *more - size * *p;
    const Eigen::MatrixXd left = -(a.transpose() * *p + *p * a + changes);
    Cholesky metric;
    SymmetricEigen eigen;
    if (!eigen.compute((left + left.transpose()) / 2, false) || !(eigen.values()[0] >= 0.5) ||
        !metric.compute(*p))
      return {};
    const Eigen::MatrixXd once = metric.forward((left + left.transpose()) / 2),
                          shape = metric.forward(once.transpose());
    if (!eigen.compute((shape + shape.transpose()) / 2, false)) return {};
    sum += eigen.values()[0] / 2 * step;
  }
  return sum;
}

} // namespace flyball
