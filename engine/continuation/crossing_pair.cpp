#include "engine/continuation/crossing_pair.hpp"

#include "engine/stability/stability.hpp"
#include "engine/stability/steady_motion.hpp"

#include <cmath>
#include <limits>

namespace flyball {

std::optional<EigenvaluePair> pair_near(const std::vector<std::complex<double>>& spectrum, double product) {
  double largest = 0;
  for (const std::complex<double> s : spectrum)
    largest = std::max(largest, std::abs(s));
  const double size = std::sqrt(std::abs(product)) + 1e-6 * largest;
  std::optional<EigenvaluePair> out;
  double best = std::numeric_limits<double>::infinity();
  const auto take = [&](EigenvaluePair pair) {
    const double away = std::abs(pair.product - product) / (size * size) + std::abs(pair.sum) / size;
    if (!(away < best)) return;
    best = away;
    out = pair;
  };
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    const std::complex<double> s = spectrum[i];
    if (s.imag() > 0) take({2 * s.real(), std::norm(s)});
    if (s.imag() != 0) continue;
    for (std::size_t k = 0; k < i; ++k)
      if (spectrum[k].imag() == 0) take({s.real() + spectrum[k].real(), s.real() * spectrum[k].real()});
  }
  return out;
}

Condition pair_crosses(double scale) {
  return {[scale](const ExtendedBalance& balance, const ExtendedState& state, Workspace& w) {
            const auto spectrum = motion_eigenvalues(balance.problem(), state.z, w);
            const auto pair = spectrum ? pair_near(*spectrum, state.pair) : std::nullopt;
            return pair ? pair->sum / scale : std::numeric_limits<double>::quiet_NaN();
          },
          {},
          true};
}

std::optional<double> pair_product(ExtendedBalance& balance, const ExtendedState& state) {
  Unknowns z = state.z;
  balance.set(state);
  factor_with_multipliers(balance.problem(), z, balance.workspace());
  const auto spectrum = motion_eigenvalues(balance.problem(), z, balance.workspace());
  const auto pair = spectrum ? pair_near(*spectrum, state.pair) : std::nullopt;
  if (!pair) return {};
  return pair->product;
}

} // namespace flyball
