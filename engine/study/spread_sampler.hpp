// The steady states of single samples, as spread.hpp and spread_band.hpp count them.
#pragma once

#include "engine/study/spread.hpp"
#include "engine/study/steady_map.hpp"

namespace flyball {

struct SpreadName {
  std::string name, unit;
};

// What is told of the samples: free coordinates and speeds that are found, then measures. Throws SceneError
// where there are too many of the first and none of the last.
std::vector<SpreadName> spread_outputs(const Mechanism& mechanism);

// The mechanism's own, by tolerance.
std::vector<double> nominal_numbers(const Mechanism& mechanism, std::span<const Tolerance> tolerances);

// One sample after the other, each from the nominal state. Refers to what it is made of.
class SpreadSampler {
 public:
  // Throws SceneError as spread() does.
  SpreadSampler(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                const std::vector<SpreadName>& outputs, const SpreadOptions& options);

  const Solution& first() const { return first_; }
  const std::optional<SteadyMap::State>& nominal() const { return nominal_; }
  // Whether its branch can be followed to samples, which make() needs.
  bool regular() const { return regular_; }
  // Of the outputs with the numbers, (outputs, numbers).
  const Eigen::MatrixXd& rates() const { return rates_; }

  // Leaves the values of the outputs, not a number where there is none.
  SampleFate make(std::size_t i, std::span<double> values);

 private:
  SampleFate solve(const std::vector<double>& numbers, std::span<double> values);

  const Mechanism& mechanism_;
  std::span<const Tolerance> tolerances_;
  const std::vector<SpreadName>& outputs_;
  const SpreadOptions& options_;
  std::vector<double> nominal_numbers_;
  SteadyMap map_;
  Solution first_;
  std::optional<SteadyMap::State> nominal_;
  bool regular_ = false;
  Eigen::MatrixXd rates_;
};

} // namespace flyball
