// What samples of a spread tell, taken one after the other, in memory that does not grow with them.
#pragma once

#include "engine/study/spread.hpp"

#include <Eigen/Core>

#include <map>

namespace flyball {

// Of one output's values. Sums are of differences from the first, so that a small scatter about a large
// number keeps its digits. Quantiles are exact of as many values as are kept; of more they are known by bins,
// a thousandth of their distance from the first value wide, evenly filled: far finer than chance.
class ValueTally {
 public:
  static constexpr std::size_t kept = 100000;

  void add(double value);
  SpreadStatistics statistics() const;

 private:
  static int bin_of(double difference);
  static double end_of(int bin, int more); // the nearer one to zero; with 1 the other

  std::size_t count_ = 0;
  double first_ = 0, least_ = 0, most_ = 0;
  std::array<double, 4> powers_{};  // sums of the differences' first to fourth powers
  std::vector<double> values_;      // while they are few
  std::map<int, std::size_t> bins_; // of all, once they are many
};

class SpreadTally {
 public:
  // Of the outputs and nominal numbers of an answer.
  SpreadTally(std::span<const Tolerance> tolerances, std::uint64_t seed, const SpreadAnswer& answer);

  // Sample i; `values`: of the outputs, not a number where there is none.
  void add(std::size_t i, SampleFate fate, std::span<const double> values);
  // Leaves counts, statistics and shares, and says how many samples went which way.
  void tell(SpreadAnswer& answer) const;

 private:
  struct Output {
    double nominal = 0;
    ValueTally followed, elsewhere;
    // Of the standardised numbers and the value: how many, sums, and sums of products.
    double count = 0;
    Eigen::VectorXd sum;
    Eigen::MatrixXd products;
  };
  std::vector<double> shares(const Output& output) const;

  std::vector<Tolerance> tolerances_;
  std::uint64_t seed_;
  std::vector<double> nominal_; // by tolerance
  std::size_t samples_ = 0;
  std::array<std::size_t, fates> counts_{};
  std::vector<Output> outputs_;
  Eigen::VectorXd row_;
};

} // namespace flyball
