#include "engine/solve/sensitivity.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/system/balance_rate.hpp"

namespace flyball {

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses) {
  // They are not set: rates alone are asked for.
  return sensitivities(at, mechanism, VariedNumbers(const_cast<Mechanism&>(mechanism), addresses));
}

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           const VariedNumbers& numbers, bool across) {
  if (at.kkt().singular() && !across) return {};
  const Problem& problem = at.problem;
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
    all.push_back(step.cwiseProduct(problem.scaling.column));
  }
  return all;
}

} // namespace flyball
