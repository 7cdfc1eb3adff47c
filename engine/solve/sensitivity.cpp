#include "engine/solve/sensitivity.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/system/balance_rate.hpp"

namespace flyball {

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses) {
  if (at.kkt().singular()) return {};
  const Problem& problem = at.problem;
  // They are not set: rates alone are asked for.
  const VariedNumbers numbers(const_cast<Mechanism&>(mechanism), addresses);
  NumberRates rates;
  BalanceRate balance;
  std::vector<Eigen::VectorXd> all;
  Eigen::VectorXd step, multipliers;
  for (std::size_t i = 0; i < addresses.size(); ++i) {
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
