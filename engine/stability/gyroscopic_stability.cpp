#include "engine/stability/gyroscopic_stability.hpp"

#include "engine/linear/pencil.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>

namespace flyball {

bool is_gyroscopically_stable(const Problem& problem, const Unknowns& z, Workspace& w) {
  if (!problem.parameters.moving || problem.system.nv < 2 || problem.system.nv > largest_for_eigenvalues)
    return false;
  const Problem whole{problem.system, problem.parameters, problem.scaling, problem.cancel};
  const FactoredState at = factor_at(whole, z, w);
  // Without gyroscopic forces what falls goes on falling: no eigenvalues are needed to know.
  linearize_motion(problem.system, problem.parameters, z.q, w.kinematics, w.dense.linearization);
  const Eigen::MatrixXd basis = problem.scaling.column.asDiagonal() * w.dense.constraints().basis();
  const Eigen::MatrixXd velocity = basis.transpose() * w.dense.linearization.velocity * basis;
  const double rounding = 1e-14 * basis.squaredNorm() * w.dense.linearization.velocity.norm();
  if ((velocity - velocity.transpose()).norm() <= rounding) return false;
  const Stability stability = find_stability(at, false);
  return stability.reason == StabilityReason::gyroscopic_only ||
         (stability.reason == StabilityReason::floquet && stability.stable == true);
}

std::optional<bool> damping_destabilizes(const Problem& problem, const Eigen::VectorXd& q,
                                         const Eigen::MatrixXd& basis, const Eigen::MatrixXd& mass,
                                         const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& stiffness,
                                         const Workspace& w) {
  Eigen::MatrixXd dampers = Eigen::MatrixXd::Zero(problem.system.nv, problem.system.nv);
  add_damping(problem.system, problem.parameters, q, w.kinematics, dampers);
  const auto& s = problem.scaling.column;
  const Eigen::MatrixXd damping = basis.transpose() * s.asDiagonal() * dampers * s.asDiagonal() * basis;
  const double size = damping.norm();
  if (!(size > 0)) return false;
  const Eigen::MatrixXd gyroscopic = (velocity - velocity.transpose()) / 2;
  const double strong = 0.1 * std::max(gyroscopic.norm(), std::sqrt(mass.norm() * stiffness.norm()));
  const auto eigenvalues =
      pencil_eigenvalues(mass, gyroscopic + damping * (strong / size), stiffness, problem.cancel);
  if (!eigenvalues) return {};
  double largest = 0;
  for (const std::complex<double> x : *eigenvalues)
    largest = std::max(largest, std::abs(x));
  return std::ranges::any_of(
      *eigenvalues, [&](std::complex<double> x) { return x.real() > 1e-6 * std::abs(x) + 1e-9 * largest; });
}

} // namespace flyball
