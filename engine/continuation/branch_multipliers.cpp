// Where motions beside a branch of equilibria begin to grow although nothing of the balance itself changes: a
// Floquet multiplier leaves the unit circle.
#include "engine/continuation/branch_follower.hpp"

#include "engine/linear/root_bracket.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// ln|mu| of the largest multiplier and the multiplier itself; nothing where there are none.
struct LargestMultiplier {
  double growth = 0;
  std::complex<double> value;
};

std::optional<LargestMultiplier> largest_multiplier(const Problem& problem, const Unknowns& z, Workspace& w) {
  const Stability stability = find_stability(factor_at(problem, z, w), false);
  if (!stability.floquet) return {};
  const std::complex<double> mu = stability.floquet->multipliers.front();
  return LargestMultiplier{std::log(std::max(std::abs(mu), stability.floquet->error)), mu}; // 0: a bound
}

} // namespace

void BranchFollower::find_multiplier_crossing(const BranchState& state, const BranchState& next,
                                              double length, FollowedBranch& out) {
  const auto at_start = largest_multiplier(problem_at(state), state.z, w_);
  const auto at_end = largest_multiplier(problem_at(next), next.z, w_);
  if (!at_start || !at_end) return;
  // A multiplier of a motion without damping lies on the circle until two meet, and leaves it with the root
  // of the distance.
  const bool damped = std::min(at_start->growth, at_end->growth) < -tolerance::departed_multiplier;
  const double limit = damped ? 0 : tolerance::departed_multiplier;
  const double at_low = at_start->growth - limit, at_high = at_end->growth - limit;
  if (at_low * at_high >= 0) return;
  RootBracket bracket(0, at_low, length, at_high);
  BranchState found = next;
  // The multiplier on the side that grows tells how it left.
  std::complex<double> grows = at_low > 0 ? at_start->value : at_end->value;
  for (int i = 0; i < 80 && bracket.width() > tolerance::special_point && !cancelled(); ++i) {
    // Where the growth begins like a root, halves do better.
    const double middle = damped ? bracket.next() : bracket.middle();
    BranchState probe;
    int iterations = 0;
    if (!continuation_.step(state, middle, probe, iterations)) break;
    const auto here = largest_multiplier(problem_at(probe), probe.z, w_);
    if (!here) break;
    const double value = here->growth - limit;
    if (value > 0) grows = here->value;
    found = std::move(probe);
    if (std::abs(value) < 1e-13) break;
    bracket.take(middle, value);
  }
  const bool real = std::abs(grows.imag()) <= 1e-3 * std::abs(grows);
  out.special.emplace_back(real     ? SpecialPointType::parametric
                           : damped ? SpecialPointType::hopf
                                    : SpecialPointType::flutter,
                           point(found));
}

} // namespace flyball
