#include "engine/solve/sensitivity.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/system/balance_rate.hpp"

namespace flyball {
namespace {

// Whether the step that was found last balances what asked for it: what pushes along null directions stays.
bool balances(const Eigen::VectorXd& step, const Workspace& w, const DenseKkt& dense) {
  constexpr double rounding = 1e-9;
  const Eigen::MatrixXd &k = dense.stiffness(), &j = dense.jacobian();
  Eigen::VectorXd left = k * step - w.scaled_force;
  Eigen::VectorXd terms = k.cwiseAbs() * step.cwiseAbs() + w.scaled_force.cwiseAbs();
  if (j.rows() > 0) {
    left += j.transpose() * w.scaled_lambda;
    terms += j.transpose().cwiseAbs() * w.scaled_lambda.cwiseAbs();
  }
  return left.size() == 0 || left.lpNorm<Eigen::Infinity>() <= rounding * terms.lpNorm<Eigen::Infinity>();
}

} // namespace

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses) {
  // They are not set: rates alone are asked for.
  return sensitivities(at, mechanism, VariedNumbers(const_cast<Mechanism&>(mechanism), addresses));
}

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           const VariedNumbers& numbers, NullDirections null) {
  const Problem& problem = at.problem;
  const DenseKkt* dense = at.w.matrices(problem);
  const bool singular = at.kkt().singular();
  if (singular && (null == NullDirections::refused || !dense)) return {};
  NumberRates rates;
  BalanceRate balance;
  std::vector<Eigen::VectorXd> all;
  Eigen::VectorXd step, multipliers;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    try {
      numbers.rates(i, rates);
    } catch (const SceneError&) { // such as of a square root at zero
      all.emplace_back();
      continue;
    }
    balance.evaluate(problem.system, mechanism, rates, problem.parameters, at.z.q, at.z.lambda);
    newton_step(problem, balance.force(), balance.phi(), at.w, step, multipliers);
    if (singular && !balances(step, at.w, *dense)) {
      all.emplace_back();
      continue;
    }
    all.push_back(step.cwiseProduct(problem.scaling.column));
  }
  return all;
}

} // namespace flyball
