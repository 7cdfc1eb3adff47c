#include "app/cli/value_columns.hpp"

#include "engine/report/analysis.hpp"

#include <cmath>

namespace flyball::cli {

std::vector<ValueColumn> value_columns(const Mechanism& mechanism) {
  std::vector<ValueColumn> values;
  const std::vector<CoordinateSolution> all = Analysis(mechanism).summary().coordinates;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const auto found = found_number(all[i]))
      values.push_back({found->name, std::string(found->unit), false, i, all[i].speed.has_value()});
  for (std::size_t i = 0; i < mechanism.measures.size(); ++i)
    values.push_back({mechanism.measures[i].name, mechanism.measures[i].unit, true, i});
  return values;
}

double value_at(std::span<const CoordinateSolution> coordinates, std::span<const MeasureSolution> measures,
                const ValueColumn& value) {
  const std::size_t i = value.place;
  if (value.measure) return i < measures.size() ? measures[i].value.value_or(std::nan("")) : std::nan("");
  if (i >= coordinates.size()) return std::nan("");
  const CoordinateSolution& c = coordinates[i];
  if (c.speed.has_value() != value.speed) return std::nan(""); // each has a column of its own
  return c.speed ? *c.speed : c.driven ? std::nan("") : c.value;
}

} // namespace flyball::cli
