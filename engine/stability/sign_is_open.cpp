#include "engine/stability/sign_is_open.hpp"

namespace flyball {

bool sign_is_open(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error, bool minimum,
                  Workspace& w) {
  DenseKkt* dense = w.matrices(problem);
  if (problem.system.nv == 0 || !dense || !problem.symmetric()) return false;
  const double away = error.cwiseQuotient(problem.scaling.column).lpNorm<Eigen::Infinity>();
  if (minimum && away < 1e-11) return false;
  Unknowns here = z;
  factor_with_multipliers(problem, here, w);
  ReducedHessian& hessian = dense->hessian();
  if (hessian.size() == 0) return false;
  if (hessian.singular()) {
    // Whatever is left open in a direction without stiffness, another one may fall for certain.
    constexpr double certain = 1e-6;
    return !(hessian.decompose() && hessian.eigenvalues()[0] < -certain);
  }
  if (!hessian.decompose()) return true;
  Eigen::Index softest = 0;
  hessian.eigenvalues().cwiseAbs().minCoeff(&softest);
  Eigen::VectorXd direction = hessian.eigenvectors().col(softest).cwiseProduct(hessian.scale());
  if (problem.system.rows > 0 && dense->constraints().rank() > 0)
    direction = (dense->constraints().basis() * direction).eval();
  direction /= direction.lpNorm<Eigen::Infinity>();
  const auto stiffness = [&] { return direction.dot(dense->stiffness() * direction); };
  const double noise = 4 * std::numeric_limits<double>::epsilon() *
                       direction.cwiseAbs().dot(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  const double least = stiffness();
  double change = noise;
  for (const double side : {4., -4.}) {
    here.q = z.q;
    const Eigen::VectorXd step = side * away * direction.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, step, here.q);
    if (!assemble(problem, here.q, 0, w)) continue;
    factor_with_multipliers(problem, here, w);
    change = std::max(change, std::abs(stiffness() - least));
  }
  return std::abs(least) <= change;
}

} // namespace flyball
