#include "engine/search/turned_rates.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/search/turned_balance.hpp"

namespace flyball {
namespace {

bool is_finite_rate(const VariedNumbers& numbers, std::size_t i, NumberRates& out) try {
  numbers.rates(i, out);
  return true;
} catch (const SceneError&) { // such as of a square root at zero
  return false;
}

} // namespace

std::vector<TurnedRate> turned_rates(const Problem& problem, const Unknowns& z, const AngleTies& ties,
                                     const Mechanism& mechanism, const VariedNumbers& numbers, Workspace& w) {
  const System& system = problem.system;
  const TurnedBalance balance(problem, z, ties, mechanism, w);
  if (!balance.usable()) return {};
  std::vector<TurnedRate> out(numbers.size());
  NumberRates rates;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!is_finite_rate(numbers, i, rates)) continue;
    const auto found = least_squares(balance.matrix(), -balance.rate(rates));
    if (!found || !found->allFinite()) continue;
    const Eigen::VectorXd along = ties.along * found->segment(system.nv, balance.angles());
    Eigen::VectorXd starts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.links.size()));
    for (std::size_t k = 0; k < ties.found.size(); ++k)
      starts[ties.found[k]] = along[static_cast<Eigen::Index>(k)];
    out[i] = {found->head(system.nv).cwiseProduct(problem.scaling.column), starts};
  }
  return out;
}

} // namespace flyball
