#include "engine/study/spread.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/study/spread_sampler.hpp"

#include <Random123/philox.h>

#include <Eigen/QR>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

namespace flyball {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(below);
  return below + 1 < sorted.size() ? sorted[below] + part * (sorted[below + 1] - sorted[below])
                                   : sorted[below];
}

// Squares of the standardised coefficients of a linear regression over the samples that followed.
std::vector<double> regression_shares(const std::vector<double>& nominal,
                                      std::span<const Tolerance> tolerances, std::uint64_t seed,
                                      const std::vector<SampleFate>& fate, const std::vector<double>& values,
                                      double middle) {
  const auto n = static_cast<Eigen::Index>(tolerances.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n + 1), x(n + 1);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n + 1, n + 1);
  double count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (fate[i] != SampleFate::followed && fate[i] != SampleFate::unstable) continue;
    if (!std::isfinite(values[i])) continue;
    const std::vector<double> numbers = sampled_numbers(nominal, tolerances, seed, i);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      x[k] = (numbers[at] - nominal[at]) / tolerances[at].deviation();
    }
    x[n] = values[i] - middle;
    mean += x;
    products += x * x.transpose();
    ++count;
  }
  if (count < static_cast<double>(n) + 2) return {};
  mean /= count;
  const Eigen::MatrixXd covariance = products / count - mean * mean.transpose();
  if (!(covariance(n, n) > 0)) return std::vector<double>(tolerances.size(), 0.);
  const Eigen::VectorXd slopes =
      covariance.topLeftCorner(n, n).colPivHouseholderQr().solve(covariance.col(n).head(n));
  std::vector<double> shares;
  for (Eigen::Index k = 0; k < n; ++k)
    shares.push_back(slopes[k] * slopes[k] * covariance(k, k) / covariance(n, n));
  return shares;
}

} // namespace

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

SpreadStatistics spread_statistics(std::vector<double> values) {
  SpreadStatistics out;
  out.count = values.size();
  if (values.empty()) return out;
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  // By differences from the middle one, so that a small scatter about a large number keeps its digits.
  const double middle = values[values.size() / 2];
  double sum = 0, squares = 0, fourth = 0;
  for (const double value : values) {
    sum += value - middle;
    squares += (value - middle) * (value - middle);
  }
  out.mean = middle + sum / n;
  if (values.size() > 1) out.deviation = std::sqrt(std::max(0., (squares - sum * sum / n) / (n - 1)));
  for (const double value : values) {
    const double square = (value - out.mean) * (value - out.mean);
    fourth += square * square / n;
  }
  const double variance = out.deviation * out.deviation;
  out.mean_error = out.deviation / std::sqrt(n);
  if (variance > 0)
    out.deviation_error = std::sqrt(std::max(0., fourth - variance * variance) / n) / (2 * out.deviation);
  out.least = values.front();
  out.most = values.back();
  out.lowest = quantile(values, 0.025);
  out.low = quantile(values, 0.05);
  out.median = quantile(values, 0.5);
  out.high = quantile(values, 0.95);
  out.highest = quantile(values, 0.975);
  return out;
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
    for (double& share : output.linear_shares)
      share = variance > 0 ? share / variance : 0;
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
  answer.samples = answer.fate.size();
  for (const SampleFate fate : answer.fate)
    ++answer.counts[static_cast<std::size_t>(fate)];
  for (std::size_t k = 0; k < answer.outputs.size(); ++k) {
    SpreadOutput& output = answer.outputs[k];
    std::vector<double> followed, elsewhere;
    for (std::size_t i = 0; i < answer.samples; ++i) {
      if (!std::isfinite(answer.values[k][i])) continue;
      (answer.fate[i] == SampleFate::elsewhere ? elsewhere : followed).push_back(answer.values[k][i]);
    }
    output.followed = spread_statistics(std::move(followed));
    output.elsewhere = spread_statistics(std::move(elsewhere));
    output.sampled_shares =
        regression_shares(answer.nominal, tolerances, seed, answer.fate, answer.values[k], output.nominal);
  }
  answer.message = std::to_string(answer.samples) + " samples: " + std::to_string(answer.counts[0]) +
                   " followed the nominal state";
  const auto also = [&](SampleFate fate, const char* words) {
    if (const std::size_t count = answer.counts[static_cast<std::size_t>(fate)])
      answer.message += ", " + std::to_string(count) + " " + words;
  };
  also(SampleFate::elsewhere, "are in another, which its branch does not lead to");
  also(SampleFate::unstable, "followed to an unstable one");
  also(SampleFate::none, "have no steady state");
  also(SampleFate::no_mechanism, "make no mechanism");
  answer.message += ".";
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
