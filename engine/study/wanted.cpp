#include "engine/study/wanted.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace flyball {

Wanted find_wanted(const Mechanism& mechanism, const System& system, const std::string& name) {
  if (const CoordinateInfo* turning = coordinate_of_speed(system, name)) return {turning};
  if (const int measure = measure_index(mechanism, name); measure >= 0)
    return {nullptr, static_cast<std::size_t>(measure)};
  try {
    return {&free_coordinate(system, name)};
  } catch (const SceneError& error) {
    if (mechanism.measures.empty()) throw;
    std::vector<std::string_view> names;
    for (const NamedMeasure& each : mechanism.measures)
      names.push_back(each.name);
    throw SceneError(error.where(), error.expected() + "; or one of the measures " + word_list(names));
  }
}

double scale_of_measure(double value, double lowest, double highest) {
  const double largest = std::max({std::abs(value), std::abs(lowest), std::abs(highest)});
  return std::isfinite(largest) && largest > 0 ? largest : 1;
}

Condition wanted_is(const Wanted& wanted, double value, double lowest, double highest) {
  return wanted.coordinate ? coordinate_is(*wanted.coordinate, value)
                           : measure_is(wanted.measure, value, scale_of_measure(value, lowest, highest));
}

std::string unit_of(const Mechanism& mechanism, const System& system, const Wanted& wanted) {
  if (!wanted.coordinate) return mechanism.measures[wanted.measure].unit;
  const bool speed = finds_speed(system.links[static_cast<std::size_t>(wanted.coordinate->link)]);
  return std::string(wanted.coordinate->angle ? "rad" : "m") + (speed ? "/s" : "");
}

std::optional<double> scale_of(const System& system, const Parameters& parameters, const Wanted& wanted) {
  if (!wanted.coordinate) return std::nullopt;
  return found_scale(system, parameters, *wanted.coordinate);
}

double away_from(const System& system, const Parameters& parameters, const Wanted& wanted, double value,
                 double goal) {
  return wanted.coordinate ? away_from(system, parameters, *wanted.coordinate, value, goal) : value - goal;
}

} // namespace flyball
