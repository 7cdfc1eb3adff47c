#include "engine/study/spread_tally.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Values in order by ranges, each with how many are in it, evenly.
class Ordered {
 public:
  void add(double low, double high, std::size_t count) {
    all_ += count;
    ranges_.push_back({all_, count, low, high});
  }
  // Of the places in between in proportion.
  double quantile(double share) const {
    const double at = share * static_cast<double>(all_ - 1);
    const auto below = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(below), value = find(below);
    return below + 1 < all_ ? value + part * (find(below + 1) - value) : value;
  }

 private:
  struct Range {
    std::size_t up_to, count;
    double low, high;
  };
  double find(std::size_t place) const {
    const Range& range = *std::ranges::upper_bound(ranges_, place, {}, &Range::up_to);
    const double within = static_cast<double>(place - (range.up_to - range.count)) + 0.5;
    return range.low + (range.high - range.low) * within / static_cast<double>(range.count);
  }
  std::size_t all_ = 0;
  std::vector<Range> ranges_;
};

// Bins of the logarithm of a difference, mirrored for those below zero.
constexpr double bin_width = 1e-3, smallest_difference = 1e-300;

} // namespace

int ValueTally::bin_of(double difference) {
  const double size = std::abs(difference);
  if (size < smallest_difference) return 0;
  const int bin = 1 + static_cast<int>(std::log(size / smallest_difference) / bin_width);
  return difference < 0 ? -bin : bin;
}

double ValueTally::end_of(int bin, int more) {
  if (bin == 0) return 0;
  const double size = smallest_difference * std::exp((std::abs(bin) - 1 + more) * bin_width);
  return bin < 0 ? -size : size;
}

void ValueTally::add(double value) {
  if (count_ == 0) first_ = least_ = most_ = value;
  ++count_;
  least_ = std::min(least_, value);
  most_ = std::max(most_, value);
  const double difference = value - first_;
  double power = 1;
  for (double& sum : powers_)
    sum += power *= difference;
  if (!bins_.empty()) {
    ++bins_[bin_of(difference)];
    return;
  }
  values_.push_back(value);
  if (values_.size() <= kept) return;
  for (const double each : values_)
    ++bins_[bin_of(each - first_)];
  values_ = {};
}

SpreadStatistics ValueTally::statistics() const {
  SpreadStatistics out;
  out.count = count_;
  if (count_ == 0) return out;
  const auto n = static_cast<double>(count_);
  const double mean = powers_[0] / n; // of the differences, as all here
  out.mean = first_ + mean;
  if (count_ > 1) out.deviation = std::sqrt(std::max(0., (powers_[1] - n * mean * mean) / (n - 1)));
  const double fourth = powers_[3] / n - 4 * mean * powers_[2] / n + 6 * mean * mean * powers_[1] / n -
                        3 * mean * mean * mean * mean;
  const double variance = out.deviation * out.deviation;
  out.mean_error = out.deviation / std::sqrt(n);
  if (variance > 0)
    out.deviation_error = std::sqrt(std::max(0., fourth - variance * variance) / n) / (2 * out.deviation);
  out.least = least_;
  out.most = most_;
  const auto end = [&](int bin, int more) { return std::clamp(first_ + end_of(bin, more), least_, most_); };
  Ordered ordered;
  if (bins_.empty()) {
    std::vector<double> sorted = values_;
    std::ranges::sort(sorted);
    for (const double value : sorted)
      ordered.add(value, value, 1);
  } else {
    for (const auto& [bin, count] : bins_)
      ordered.add(end(bin, bin < 0 ? 1 : 0), end(bin, bin < 0 ? 0 : 1), count);
  }
  out.lowest = ordered.quantile(0.025);
  out.low = ordered.quantile(0.05);
  out.median = ordered.quantile(0.5);
  out.high = ordered.quantile(0.95);
  out.highest = ordered.quantile(0.975);
  return out;
}

SpreadStatistics spread_statistics(std::span<const double> values) {
  ValueTally tally;
  for (const double value : values)
    tally.add(value);
  return tally.statistics();
}

SpreadTally::SpreadTally(std::span<const Tolerance> tolerances, std::uint64_t seed,
                         const SpreadAnswer& answer)
    : tolerances_(tolerances.begin(), tolerances.end()), seed_(seed), nominal_(answer.nominal) {
  const auto n = static_cast<Eigen::Index>(tolerances.size());
  row_.resize(n + 1);
  for (const SpreadOutput& each : answer.outputs) {
    Output& output = outputs_.emplace_back();
    output.nominal = each.nominal;
    output.sum.setZero(n + 1);
    output.products.setZero(n + 1, n + 1);
  }
}

void SpreadTally::add(std::size_t i, SampleFate fate, std::span<const double> values) {
  ++samples_;
  ++counts_[static_cast<std::size_t>(fate)];
  const bool followed = fate == SampleFate::followed || fate == SampleFate::unstable;
  const Eigen::Index last = row_.size() - 1;
  if (followed) {
    const std::vector<double> numbers = sampled_numbers(nominal_, tolerances_, seed_, i);
    for (std::size_t k = 0; k < numbers.size(); ++k)
      row_[static_cast<Eigen::Index>(k)] = (numbers[k] - nominal_[k]) / tolerances_[k].deviation();
  }
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    Output& output = outputs_[k];
    if (!std::isfinite(values[k])) continue;
    (fate == SampleFate::elsewhere ? output.elsewhere : output.followed).add(values[k]);
    if (!followed) continue;
    row_[last] = values[k] - output.nominal;
    output.sum += row_;
    output.products.noalias() += row_ * row_.transpose();
    ++output.count;
  }
}

// Squares of the standardised coefficients of a linear regression over the samples that followed.
std::vector<double> SpreadTally::shares(const Output& output) const {
  const Eigen::Index n = row_.size() - 1;
  if (output.count < static_cast<double>(n) + 2) return {};
  const Eigen::VectorXd mean = output.sum / output.count;
  const Eigen::MatrixXd covariance = output.products / output.count - mean * mean.transpose();
  if (!(covariance(n, n) > 0)) return std::vector<double>(tolerances_.size(), 0.);
  const Eigen::VectorXd slopes =
      covariance.topLeftCorner(n, n).colPivHouseholderQr().solve(covariance.col(n).head(n));
  std::vector<double> shares;
  for (Eigen::Index k = 0; k < n; ++k)
    shares.push_back(slopes[k] * slopes[k] * covariance(k, k) / covariance(n, n));
  return shares;
}

void SpreadTally::tell(SpreadAnswer& answer) const {
  answer.samples = samples_;
  answer.counts = counts_;
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    answer.outputs[k].followed = outputs_[k].followed.statistics();
    answer.outputs[k].elsewhere = outputs_[k].elsewhere.statistics();
    answer.outputs[k].sampled_shares = shares(outputs_[k]);
  }
  answer.message =
      std::to_string(samples_) + " samples: " + std::to_string(counts_[0]) + " followed the nominal state";
  const auto also = [&](SampleFate fate, const char* words) {
    if (const std::size_t count = counts_[static_cast<std::size_t>(fate)])
      answer.message += ", " + std::to_string(count) + " " + words;
  };
  also(SampleFate::elsewhere, "are in another, which its branch does not lead to");
  also(SampleFate::unstable, "followed to an unstable one");
  also(SampleFate::none, "have no steady state");
  also(SampleFate::no_mechanism, "make no mechanism");
  answer.message += ".";
}

} // namespace flyball
