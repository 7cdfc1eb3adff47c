// How far a steady state scatters where numbers of the mechanism have tolerances: by samples, and by its
// rates.
//
// Every sample is a function of the seed and its index alone (Philox, a counter-based generator: Salmon et
// al., Parallel random numbers: as easy as 1, 2, 3, SC 2011), and is solved from the nominal state, so that
// the answer is the same to the bit whatever threads or processes share the samples.
#pragma once

#include "engine/report/analysis.hpp"
#include "engine/study/work_sharing.hpp"

#include <cstdint>
#include <span>

namespace flyball {

enum class Distribution { normal, uniform, triangular };
std::string_view word(Distribution distribution);

// Around the number's nominal value.
struct Tolerance {
  std::string address;
  Distribution distribution = Distribution::normal;
  double width =
      0; // in the number's unit, > 0: standard deviation of a normal one, else half the whole width
  double deviation() const; // standard
  bool operator==(const Tolerance&) const = default;
};

// What became of a sample.
enum class SampleFate : unsigned char {
  followed,     // the nominal state's branch leads there
  elsewhere,    // it does not, as beyond a fold: the steady state that the drawn pose then leads to
  unstable,     // followed, to a state that is not stable
  none,         // no steady state
  no_mechanism, // the numbers make none: a mass below zero, loops that cannot be closed
};
constexpr int fates = 5;
std::string_view word(SampleFate fate);

struct SpreadOptions {
  std::size_t samples = 1000;
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, double>> start{}; // of the nominal state, as of SolveOptions
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(std::size_t done, std::size_t all)> progress{};
};

struct SpreadStatistics {
  std::size_t count = 0;
  double mean = 0, deviation = 0, least = 0, most = 0;
  double low = 0, median = 0, high = 0; // quantiles 0.05, 0.5, 0.95, interpolated
  double lowest = 0, highest = 0;       // quantiles 0.025 and 0.975: between them are 95 %
  // Standard errors of mean and deviation: how far as many other samples would put them.
  double mean_error = 0, deviation_error = 0;
};
SpreadStatistics spread_statistics(std::span<const double> values);

struct SpreadOutput {
  std::string name, unit; // a free coordinate's label (rad, m), or a measure
  double nominal = 0;
  SpreadStatistics followed;  // of samples that followed, stable or not
  SpreadStatistics elsewhere; // of those on another branch
  // By the rates at the nominal state, to first order: standard deviation, and of its square the share of
  // each tolerance, 0 where it is rounding.
  double linear_deviation = 0;
  std::vector<double> linear_shares;
  // The same by the samples that followed: squares of the standardised regression coefficients. What they
  // leave of 1 is not linear, or chance, whose size is about 1 / samples.
  std::vector<double> sampled_shares;
};

struct SpreadAnswer {
  Status status = Status::not_converged; // converged: there is a nominal state; else `message` says why not
  std::string message;
  std::vector<double> nominal; // the numbers, by tolerance
  std::size_t samples = 0;
  std::array<std::size_t, fates> counts{}; // by SampleFate
  std::vector<SpreadOutput> outputs;
  std::vector<std::vector<double>> values; // by output: of each sample, not a number where there is none
  std::vector<SampleFate> fate;            // of each sample
  double run_time_s = 0;
};

// The numbers of sample i, by tolerance, in their units.
std::vector<double> sampled_numbers(std::span<const double> nominal, std::span<const Tolerance> tolerances,
                                    std::uint64_t seed, std::size_t i);

// All of it. Throws SceneError for addresses that the mechanism does not take, and for tolerances without a
// width.
SpreadAnswer spread(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                    const SpreadOptions& options, WorkSharing& sharing);

// The same in parts, for those who keep no samples, or have them from elsewhere. First the nominal state and
// what its rates promise.
SpreadAnswer spread_by_rates(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                             const SpreadOptions& options);
// Then samples: `count` of them from `first` on, one after the other. `values`: of the outputs, not a number
// where there is none.
using TakeSample = std::function<void(std::size_t i, SampleFate fate, std::span<const double> values)>;
void make_samples(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                  const SpreadOptions& options, std::size_t first, std::size_t count, WorkSharing& sharing,
                  const TakeSample& take);
// At last what they tell: of the answer's `values` and `fate`. SpreadTally does it without keeping them.
void add_statistics(std::span<const Tolerance> tolerances, std::uint64_t seed, SpreadAnswer& answer);

} // namespace flyball
