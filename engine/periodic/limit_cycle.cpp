#include "engine/periodic/limit_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace flyball {
namespace {

constexpr double cycle_patience = 10; // see PeriodicOptions

// Whether anything in it moves beside what goes on: by its range, and by that of its rate over a radian of
// the cycle.
bool anything_swings(const PeriodicState& state) {
  constexpr double least = 1e-6; // scaled
  const double radian = state.period / (2 * std::numbers::pi);
  return std::ranges::any_of(state.coordinates, [&](const PeriodicCoordinate& c) {
    return std::max(c.range.most - c.range.least, radian * (c.rate.most - c.rate.least)) > least * c.scale;
  });
}

} // namespace

bool hunts(const Solution& solution) {
  if (solution.status != Status::converged || solution.stable != false) return false;
  const auto swinging = [](const std::complex<double>& z) { return std::abs(z.imag()) > 1e-6 * std::abs(z); };
  if (solution.floquet && !solution.floquet->multipliers.empty())
    return swinging(solution.floquet->multipliers.front());
  if (!solution.eigenvalues || solution.eigenvalues->empty()) return false;
  return swinging(*std::ranges::max_element(*solution.eigenvalues, {},
                                            [](const std::complex<double>& z) { return z.real(); }));
}

PeriodicState find_limit_cycle(const Mechanism& mechanism, const std::atomic<bool>* cancel,
                               const ReportProgress& progress) {
  PeriodicOptions options;
  options.patience = cycle_patience;
  options.cancel = cancel;
  options.progress = progress;
  PeriodicState state = find_periodic_state(mechanism, options);
  if (state.status == PeriodicStatus::found && !anything_swings(state)) {
    state.status = PeriodicStatus::not_found;
    state.message = "No limit cycle was found: the search led back to the steady state.";
  }
  return state;
}

} // namespace flyball
