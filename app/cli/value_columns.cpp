#include "app/cli/value_columns.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_ways.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball::cli {

namespace {

std::vector<ValueColumn> coordinate_columns(const Mechanism& mechanism,
                                            const std::vector<std::string>& slipping) {
  std::vector<ValueColumn> values;
  const std::vector<CoordinateSolution> all = Analysis(mechanism).summary().coordinates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = found_number(all[i]);
    if (!found) continue;
    values.push_back({found->name, std::string(found->unit), false, i, all[i].speed.has_value()});
    if (!all[i].speed && std::ranges::find(slipping, found->name) != slipping.end())
      values.push_back({found->name + ".speed", all[i].angle ? "rad/s" : "m/s", false, i, true});
  }
  return values;
}

} // namespace

std::vector<ValueColumn> value_columns(const Mechanism& mechanism, std::span<const Variation> variations) {
  std::vector<std::string> slipping;
  if (has_friction(mechanism)) slipping = slipping_coordinates(mechanism);
  std::vector<ValueColumn> values = coordinate_columns(mechanism, slipping);
  // Where one turns at a speed that is found, another may in its place at other numbers.
  const bool turning = std::ranges::any_of(values, &ValueColumn::speed);
  for (const Variation& variation : turning ? variations : std::span<const Variation>())
    for (const double end : {variation.value(0), variation.value(variation.count - 1)})
      try {
        Mechanism there = mechanism;
        set_parameter(there, variation.address, end);
        for (ValueColumn& column : coordinate_columns(there, slipping))
          if (std::ranges::find(values, column.name, &ValueColumn::name) == values.end())
            values.push_back(std::move(column));
      } catch (const SceneError&) { // the points tell of it
      }
  std::ranges::stable_sort(values, {}, &ValueColumn::place);
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
  if (value.speed) return c.speed ? *c.speed : c.driven ? std::nan("") : 0;
  return c.speed || c.driven ? std::nan("") : c.value;
}

std::string_view friction_word(std::span<const FrictionForce> frictions) {
  if (frictions.empty()) return "";
  return std::ranges::any_of(frictions, &FrictionForce::slips) ? "slips" : "held";
}

} // namespace flyball::cli
