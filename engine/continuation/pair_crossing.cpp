#include "engine/continuation/pair_crossing.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

using Complex = std::complex<double>;

double largest_of(const Spectrum& spectrum) {
  double largest = 0;
  for (const Complex s : spectrum)
    largest = std::max(largest, std::abs(s));
  return largest;
}

// Real parts up to this are rounding. An eigenvalue that is `gap` away from the next takes a relative error
// of the matrix times largest / gap; of two that meet the error is the root of rounding.
double rounding_of(const Spectrum& spectrum, std::size_t i, double largest, bool families) {
  const double size = std::abs(spectrum[i]), met = 1e-7 * size + (families ? 1e-5 : 1e-9) * largest;
  if (families) return met;
  double gap = largest;
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    if (k != i) gap = std::min(gap, std::abs(spectrum[k] - spectrum[i]));
  return gap > 0 ? std::min(met, 1e-8 * size + 1e-12 * largest * (largest / gap)) : met;
}

// Those above the real axis closest to `centre`, `count` of them or all there are.
Spectrum cluster_at(const Spectrum& spectrum, Complex centre, std::size_t count) {
  Spectrum above;
  for (const Complex s : spectrum)
    if (s.imag() > 0) above.push_back(s);
  std::ranges::sort(above, {}, [&](Complex s) { return std::abs(s - centre); });
  above.resize(std::min(count, above.size()));
  return above;
}

Complex mean_of(const Spectrum& cluster) {
  Complex sum = 0;
  for (const Complex s : cluster)
    sum += s;
  return sum / static_cast<double>(cluster.size());
}

} // namespace

int right_of_axis(const Spectrum& spectrum, bool families) {
  const double largest = largest_of(spectrum);
  int right = 0;
  for (std::size_t i = 0; i < spectrum.size(); ++i)
    if (spectrum[i].real() > rounding_of(spectrum, i, largest, families)) ++right;
  return right;
}

std::vector<PairCrossing> possible_crossings(const Spectrum& unstable, int more, bool families) {
  const double largest = largest_of(unstable);
  std::vector<std::size_t> right;
  for (std::size_t i = 0; i < unstable.size(); ++i)
    if (unstable[i].imag() > 1e-9 * largest &&
        unstable[i].real() > rounding_of(unstable, i, largest, families))
      right.push_back(i);
  std::ranges::sort(right, {}, [&](std::size_t i) { return unstable[i].real() / std::abs(unstable[i]); });
  std::vector<PairCrossing> out;
  for (const std::size_t i : right) {
    const Complex s = unstable[i];
    // Undamped eigenvalues lie in mirror images about the axis; their sum is known to rounding.
    for (std::size_t count = 2 * static_cast<std::size_t>(std::max(1, more / 2)); count >= 2; count -= 2) {
      const Spectrum cluster = cluster_at(unstable, Complex(0, s.imag()), count);
      if (cluster.size() < count) continue;
      const Complex mean = mean_of(cluster);
      const bool mirrored = std::ranges::all_of(cluster, [&](Complex x) {
        return std::abs(std::abs(x.real()) - s.real()) < 1e-3 * s.real() &&
               std::abs(x.imag() - s.imag()) < 0.1 * s.real();
      });
      if (!mirrored || std::abs(mean.real()) > std::min(1e-9 * std::abs(s) + 1e-11 * largest, 0.1 * s.real()))
        continue;
      out.push_back({true, Complex(0, mean.imag()), count});
      break;
    }
    out.push_back({false, s, 1});
  }
  return out;
}

std::optional<double> crossing_value(const Spectrum& spectrum, const PairCrossing& crossing) {
  const Spectrum cluster = cluster_at(spectrum, crossing.at, crossing.cluster);
  if (cluster.size() < crossing.cluster) return {};
  if (!crossing.coalescence) return cluster.front().real();
  const Complex mean = mean_of(cluster);
  Complex sum = 0;
  for (const Complex s : cluster)
    sum += (s - mean) * (s - mean);
  return 4 * sum.real() / static_cast<double>(cluster.size());
}

Complex nearest_eigenvalue(const Spectrum& spectrum, Complex s) {
  return *std::ranges::min_element(spectrum, {}, [&](Complex x) { return std::abs(x - s); });
}

} // namespace flyball
