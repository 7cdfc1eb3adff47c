// What the computations of eigenvalues share.
#pragma once

#include "engine/linear/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace flyball {

inline bool all_finite(const std::vector<std::complex<double>>& values) {
  return std::ranges::all_of(
      values, [](std::complex<double> x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); });
}

// What `compute` returns, or a value without content where the flag is set meanwhile.
template <class Compute>
auto unless_interrupted(CancelFlag cancel, const Compute& compute) -> decltype(compute()) {
  const Interruptible scope(cancel);
  try {
    return compute();
  } catch (const Interrupted&) {
    return {};
  }
}

} // namespace flyball
