#include "engine/study/spread_sampler.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/study/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr std::size_t most_coordinates = 64; // that are told; of more the measures alone

std::vector<FreeNumber> free_numbers(const Mechanism& mechanism, std::span<const Tolerance> tolerances) {
  std::vector<FreeNumber> free;
  for (const Tolerance& tolerance : tolerances) {
    if (!(tolerance.width > 0) || !std::isfinite(tolerance.width))
      throw SceneError(tolerance.address, "expected a tolerance above zero");
    const double value = get_parameter(mechanism, tolerance.address);
    free.push_back({tolerance.address, value - tolerance.width, value + tolerance.width});
  }
  return free;
}

std::vector<std::string> names_of(const std::vector<SpreadName>& outputs) {
  std::vector<std::string> names;
  for (const SpreadName& output : outputs)
    names.push_back(output.name);
  return names;
}

} // namespace

std::vector<double> nominal_numbers(const Mechanism& mechanism, std::span<const Tolerance> tolerances) {
  std::vector<double> numbers;
  for (const Tolerance& tolerance : tolerances)
    numbers.push_back(get_parameter(mechanism, tolerance.address));
  return numbers;
}

std::vector<SpreadName> spread_outputs(const Mechanism& mechanism) {
  std::vector<SpreadName> out;
  for (const CoordinateSolution& c : Analysis(mechanism).summary().coordinates)
    if (const auto found = found_number(c); found && !c.dependent)
      out.push_back({found->name, std::string(found->unit)});
  if (out.empty() && mechanism.measures.empty())
    throw SceneError("joints", "expected a coordinate that is free, or a measure: nothing scatters here");
  if (out.size() > most_coordinates) out.clear();
  for (const NamedMeasure& measure : mechanism.measures)
    out.push_back({measure.name, measure.unit});
  if (out.empty())
    throw SceneError("measures", "expected one or more: of so many coordinates none is told by itself");
  return out;
}

SpreadSampler::SpreadSampler(const Mechanism& mechanism, std::span<const Tolerance> tolerances,
                             const std::vector<SpreadName>& outputs, const SpreadOptions& options)
    : mechanism_(mechanism), tolerances_(tolerances), outputs_(outputs), options_(options),
      nominal_numbers_(nominal_numbers(mechanism, tolerances)),
      map_(mechanism, free_numbers(mechanism, tolerances), names_of(outputs), options.cancel),
      nominal_(map_.begin(options.start, first_)) {
  if (!nominal_ ||
      !(map_.find_rates(*nominal_) || (map_.follow_across(*nominal_) && map_.find_rates(*nominal_))))
    return;
  regular_ = true;
  rates_ = map_.rates();
}

SampleFate SpreadSampler::make(std::size_t i, std::span<double> values) {
  std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> numbers = sampled_numbers(nominal_numbers_, tolerances_, options_.seed, i);
  const Eigen::VectorXd p = Eigen::Map<const Eigen::VectorXd>(numbers.data(), map_.count());
  if (SteadyMap::State state = *nominal_; map_.walk_to(state, p)) {
    const Solution solution = map_.solution(state, false);
    if (solution.status == Status::converged) {
      std::ranges::copy(state.values, values.begin());
      return solution.stable == false ? SampleFate::unstable : SampleFate::followed;
    }
  }
  return solve(numbers, values);
}

// As a scene by itself.
SampleFate SpreadSampler::solve(const std::vector<double>& numbers, std::span<double> values) {
  Mechanism there = mechanism_;
  std::vector<ParameterValue> set;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    set.push_back({tolerances_[k].address, numbers[k]});
  try {
    set_parameters(there, set);
    validate(there);
  } catch (const SceneError&) {
    return SampleFate::no_mechanism;
  }
  SolveOptions solve;
  solve.details = false;
  solve.search = point_search;
  solve.friction = false; // which holds samples as drawn
  solve.cancel = options_.cancel;
  const Solution solution = Analysis(there).solve(solve);
  if (solution.status == Status::infeasible) return SampleFate::no_mechanism;
  if (solution.status != Status::converged) return SampleFate::none;
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    if (map_.is_open(k)) continue;
    for (const CoordinateSolution& c : solution.coordinates)
      if (const auto found = found_number(c); found && found->name == outputs_[k].name)
        values[k] = found->value;
    for (const MeasureSolution& measure : solution.measures)
      if (measure.name == outputs_[k].name && measure.value) values[k] = *measure.value;
  }
  return SampleFate::elsewhere;
}

} // namespace flyball
