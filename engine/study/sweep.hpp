// A mechanism solved over a grid of parameter values. Every point is solved from the drawn pose, so that a
// row says the same as a solve of its own would, in whatever order the rows were computed.
#pragma once

#include "engine/report/analysis.hpp"

#include <functional>
#include <span>

namespace flyball {

struct Variation {
  std::string address;
  double from = 0, to = 0;
  int count = 2; // values, ends included; 1: `from` alone
  double value(int i) const;
};

struct SweepPoint {
  std::vector<double> parameters; // by variation
  Solution solution;              // without details
};

// All combinations, the last variation moving fastest. Uses up to `threads` threads (0: all cores);
// `progress` is called from the calling thread with the number of points done. `cancel` is polled between
// points and iterations; points that were not reached are then not_converged. Throws SceneError for an
// address or a value that the mechanism does not take.
std::vector<SweepPoint> sweep(const Mechanism& mechanism, std::span<const Variation> variations,
                              int threads = 0,
                              const std::function<void(std::size_t done, std::size_t all)>& progress = {},
                              const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
