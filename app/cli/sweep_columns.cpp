#include "app/cli/sweep_columns.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball::cli {

SweepColumns::SweepColumns(const Mechanism& mechanism, std::vector<Variation> varied, bool with_times)
    : variations(std::move(varied)), times(with_times) {
  const std::vector<CoordinateSolution> all = Analysis(mechanism).summary().coordinates;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const auto found = found_number(all[i]))
      values.push_back({found->name, std::string(found->unit), false, i});
  for (std::size_t i = 0; i < mechanism.measures.size(); ++i)
    values.push_back({mechanism.measures[i].name, mechanism.measures[i].unit, true, i});
}

std::vector<std::string> SweepColumns::names() const {
  std::vector<std::string> all;
  for (const Variation& variation : variations)
    all.push_back(variation.address);
  all.emplace_back("status");
  for (const Value& value : values)
    all.push_back(value.name);
  all.insert(all.end(), {"stable", "residual"});
  if (times) all.emplace_back("run_time_s");
  return all;
}

double value_at(const Solution& solution, const SweepColumns::Value& value) {
  const std::size_t i = value.place;
  if (value.measure)
    return i < solution.measures.size() ? solution.measures[i].value.value_or(std::nan("")) : std::nan("");
  if (i >= solution.coordinates.size()) return std::nan("");
  const CoordinateSolution& c = solution.coordinates[i];
  return c.speed ? *c.speed : c.driven ? std::nan("") : c.value;
}

} // namespace flyball::cli
