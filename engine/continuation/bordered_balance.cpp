#include "engine/continuation/bordered_balance.hpp"

#include "engine/continuation/dense_borders.hpp"
#include "engine/continuation/kkt_borders.hpp"
#include "engine/solve/newton.hpp"

namespace flyball {

std::unique_ptr<BorderedBalance> BorderedBalance::make(Family& family, Workspace& w) {
  if (family.problem().form == KktForm::dense) return std::make_unique<DenseBorders>(family, w);
  return std::make_unique<KktBorders>(family, w);
}

void BorderedBalance::find_rates(const Unknowns& z, double parameter) {
  const Problem problem = family_.problem();
  const double h = 1e-6 * family_.scale();
  Eigen::VectorXd f[2], phi[2];
  const auto on_both_sides = [&](const Unknowns& at) {
    for (int i : {0, 1}) {
      family_.set(parameter + (i == 0 ? h : -h));
      evaluate(problem, at, 0, w_);
      f[i] = w_.residual.f;
      phi[i] = w_.residual.phi;
    }
  };
  // Multipliers would only add their rounding, but for a length that turns what they act along.
  w_.zero_lambda.setZero(problem.system.rows);
  on_both_sides({z.q, w_.zero_lambda});
  if (phi[0] != phi[1]) on_both_sides(z);
  family_.set(parameter);
  const double per = family_.scale() / (2 * h);
  loop_rate_ = ((phi[0] - phi[1]) * per).cwiseProduct(problem.scaling.row);
  force_rate_ = ((f[0] - f[1]) * per).cwiseProduct(problem.scaling.column);
  evaluate(problem, z, 0, w_);
}

} // namespace flyball
