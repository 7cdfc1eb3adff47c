// A scan for the best settings: random samples in a box of logarithms, then a pattern search from the best of
// them. Untimed.
#pragma once

#include "tests/bench/peers/clock.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace flyball::peers {

struct Range {
  double from = 0, to = 0; // both positive
};

struct Tuned {
  std::vector<double> values;
  double cost = 1e300;
};

using Cost = std::function<double(const std::vector<double>&)>;

// Gives up after `seconds`, but not before the first guess.
inline Tuned tune(const std::vector<Range>& ranges, const std::vector<std::vector<double>>& guesses,
                  int samples, double seconds, const Cost& cost) {
  const double begin = thread_seconds();
  const auto time_left = [&] { return thread_seconds() - begin < seconds; };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Tuned> tried;
  const auto attempt = [&](std::vector<double> x) {
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = std::clamp(x[k], ranges[k].from, ranges[k].to);
    const double c = cost(x);
    return Tuned{std::move(x), c};
  };
  for (const std::vector<double>& x : guesses)
    if (tried.empty() || time_left()) tried.push_back(attempt(x));
  for (int i = 0; i < samples && time_left(); ++i) {
    std::vector<double> x;
    for (const Range& r : ranges)
      x.push_back(r.from * std::pow(r.to / r.from, share(random)));
    tried.push_back(attempt(std::move(x)));
  }
  std::sort(tried.begin(), tried.end(), [](const Tuned& a, const Tuned& b) { return a.cost < b.cost; });
  Tuned best = tried.front();
  for (std::size_t i = 0; i < std::min<std::size_t>(4, tried.size()); ++i) {
    Tuned here = tried[i];
    for (double factor = 2; factor > 1.002 && time_left();) {
      bool better = false;
      for (std::size_t k = 0; k < ranges.size() && time_left(); ++k)
        for (const double f : {factor, 1 / factor}) {
          std::vector<double> x = here.values;
          x[k] *= f;
          Tuned there = attempt(std::move(x));
          if (there.cost < here.cost) {
            here = std::move(there);
            better = true;
          }
        }
      if (!better) factor = std::sqrt(factor);
    }
    if (here.cost < best.cost) best = here;
  }
  return best;
}

// The cost of a run that has not arrived: beyond any that has, and the less the nearer it came.
inline double not_arrived(double error) {
  return 1e9 * (1 + (std::isfinite(error) ? std::min(1e3, std::log10(1 + error / 1e-6)) : 1e3));
}

// At which step, fractional by interpolating the logarithm, errors fall below `level` for good; negative
// where they do not.
inline double settling_step(const std::vector<double>& errors, double level) {
  std::size_t n = errors.size();
  while (n > 0 && errors[n - 1] < level)
    --n;
  if (n == errors.size()) return -1;
  if (n == 0) return 0;
  const double above = std::log(errors[n - 1] / level), below = std::log(level / std::max(errors[n], 1e-17));
  return static_cast<double>(n) - 1 + above / (above + below);
}

} // namespace flyball::peers
