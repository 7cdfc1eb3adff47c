#include "engine/study/spread.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/study/spread_sampler.hpp"
#include "engine/study/spread_tally.hpp"

// Products of 64 bits in plain C, the same bits, where nothing faster is known, as to WebAssembly.
#define R123_USE_MULHILO64_C99 1
#include <Random123/philox.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

namespace flyball {

std::string_view word(Distribution distribution) {
  switch (distribution) {
  case Distribution::normal: return "normal";
  case Distribution::uniform: return "uniform";
  case Distribution::triangular: return "triangular";
  }
  return "";
}

std::string_view word(SampleFate fate) {
  switch (fate) {
  case SampleFate::followed: return "followed";
  case SampleFate::elsewhere: return "elsewhere";
  case SampleFate::unstable: return "unstable";
  case SampleFate::none: return "none";
  case SampleFate::no_mechanism: return "no_mechanism";
  }
  return "";
}

double Tolerance::deviation() const {
  switch (distribution) {
  case Distribution::normal: return width;
  case Distribution::uniform: return width / std::sqrt(3.);
  case Distribution::triangular: return width / std::sqrt(6.);
  }
  return width;
}

std::vector<double> sampled_numbers(std::span<const double> nominal, std::span<const Tolerance> tolerances,
                                    std::uint64_t seed, std::size_t i) {
  // In (0, 1), by the upper 53 bits.
  const auto share = [](std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; };
  std::vector<double> numbers;
  numbers.reserve(tolerances.size());
  for (std::size_t k = 0; k < tolerances.size(); ++k) {
    const r123::Philox2x64 generator;
    const auto bits = generator(r123::Philox2x64::ctr_type{{i, k}}, r123::Philox2x64::key_type{{seed}});
    const double a = share(bits[0]), b = share(bits[1]);
    double at = 0;
    switch (tolerances[k].distribution) {
    case Distribution::normal: // Box, Muller 1958
      at = std::sqrt(-2 * std::log(a)) * std::cos(2 * std::numbers::pi * b);
      break;
    case Distribution::uniform: at = 2 * a - 1; break;
    case Distribution::triangular: at = a + b - 1; break;
    }
    numbers.push_back(nominal[k] + at * tolerances[k].width);
  }
  return numbers;
}

SpreadAnswer spread_by_rates(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                             const SpreadOptions& options) {
  SpreadAnswer out;
  const std::vector<SpreadName> outputs = spread_outputs(mechanism);
  out.nominal = nominal_numbers(mechanism, tolerances);
  const SpreadSampler sampler(mechanism, tolerances, outputs, options);
  out.status = sampler.first().status;
  if (!sampler.nominal()) {
    out.message = sampler.first().message;
    return out;
  }
  if (!sampler.regular()) {
    out.status = Status::not_converged;
    out.message =
        "The nominal steady state is singular, as at a fold or where nothing resists: its branch cannot be "
        "followed to samples.";
    return out;
  }
  constexpr double rounding = 1e-13; // of the nominal value
  const Eigen::MatrixXd& rates = sampler.rates();
  for (Eigen::Index k = 0; k < rates.rows(); ++k) {
    const SpreadName& named = outputs[static_cast<std::size_t>(k)];
    SpreadOutput output;
    output.name = named.name;
    output.unit = named.unit;
    output.nominal = sampler.nominal()->values[k];
    double variance = 0;
    const bool rated = rates.row(k).allFinite();
    for (std::size_t t = 0; t < tolerances.size() && rated; ++t) {
      const double by = rates(k, static_cast<Eigen::Index>(t)) * tolerances[t].deviation();
      output.linear_shares.push_back(by * by);
      variance += by * by;
    }
    const double least = rounding * std::abs(output.nominal);
    for (double& share : output.linear_shares)
      share = variance > least * least ? share / variance : 0;
    output.linear_deviation = std::sqrt(variance);
    out.outputs.push_back(std::move(output));
  }
  return out;
}

void make_samples(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                  const SpreadOptions& options, std::size_t first, std::size_t count, WorkSharing& sharing,
                  const TakeSample& take) {
  // A block has of each sample its fate and the values, as bytes of doubles.
  const std::vector<SpreadName> outputs = spread_outputs(mechanism);
  const std::size_t width = outputs.size() + 1;
  SharedWork work;
  work.count = count;
  work.cancel = options.cancel;
  if (options.progress) work.progress = options.progress;
  work.maker = [&] {
    auto sampler = std::make_shared<SpreadSampler>(mechanism, tolerances, outputs, options);
    return [sampler, width, first, &options](std::size_t from, std::size_t to) {
      const Interruptible scope(options.cancel);
      std::vector<double> row(width);
      std::string block;
      if (!sampler->regular()) return block; // cancelled before it knew the nominal state
      try {
        for (std::size_t i = from; i < to; ++i) {
          row[0] = static_cast<double>(sampler->make(first + i, std::span(row).subspan(1)));
          block.append(reinterpret_cast<const char*>(row.data()), width * sizeof(double));
        }
      } catch (const Interrupted&) { // nothing more is taken
      }
      return block;
    };
  };
  work.take = [&](std::size_t from, std::size_t, std::string_view block) {
    std::vector<double> row(width);
    for (std::size_t i = first + from; block.size() >= width * sizeof(double); ++i) {
      std::memcpy(row.data(), block.data(), width * sizeof(double));
      block.remove_prefix(width * sizeof(double));
      take(i, static_cast<SampleFate>(static_cast<unsigned char>(row[0])), std::span(row).subspan(1));
    }
  };
  sharing.run(work);
}

void add_statistics(std::span<const Tolerance> tolerances, std::uint64_t seed, SpreadAnswer& answer) {
  SpreadTally tally(tolerances, seed, answer);
  std::vector<double> values(answer.outputs.size());
  for (std::size_t i = 0; i < answer.fate.size(); ++i) {
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = answer.values[k][i];
    tally.add(i, answer.fate[i], values);
  }
  tally.tell(answer);
}

SpreadAnswer spread(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                    const SpreadOptions& options, WorkSharing& sharing) {
  const auto begin = std::chrono::steady_clock::now();
  SpreadAnswer out = spread_by_rates(mechanism, tolerances, options);
  if (out.status != Status::converged) return out;
  out.values.assign(out.outputs.size(), std::vector<double>(options.samples));
  out.fate.resize(options.samples);
  make_samples(mechanism, tolerances, options, 0, options.samples, sharing,
               [&](std::size_t i, SampleFate fate, std::span<const double> values) {
                 out.fate[i] = fate;
                 for (std::size_t k = 0; k < values.size(); ++k)
                   out.values[k][i] = values[k];
               });
  if (options.cancel && *options.cancel) {
    out.status = Status::not_converged;
    out.message = "Cancelled.";
    return out;
  }
  if (!sharing.takes()) return out;
  add_statistics(tolerances, options.seed, out);
  out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

} // namespace flyball
