#include "engine/mechanism/given_names.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/unit_hint.hpp"

#include <algorithm>

namespace flyball {
namespace {

template <class N>
void take_numbers(const Mechanism& mechanism, const NumberReader<N>& read, std::span<Dual> all) {
  std::size_t at = 0;
  for (const NamedParameter& parameter : mechanism.parameters)
    all[at++] = read(parameter.value);
  for (const NamedPoint& point : mechanism.points)
    for (const double& coordinate : point.at)
      all[at++] = read(coordinate);
}

} // namespace

GivenNames::GivenNames(const Mechanism& mechanism) : mechanism_(mechanism) {
  for (const NamedParameter& parameter : mechanism.parameters) {
    numbers_.emplace(parameter.name, numbers_.size());
    const std::optional<Unit> unit = parse_unit(parameter.unit);
    if (!unit || unit->factor != 1)
      throw SceneError("parameters." + parameter.name + ".unit",
                       "expected an SI unit, such as m, N/m or rad, found \"" + parameter.unit + "\"");
    dimensions_.push_back({unit->dimension.without_angle(), false});
  }
  for (const NamedPoint& point : mechanism.points)
    for (const int i : {0, 1, 2}) {
      numbers_.emplace(point_coordinate(point.name, i), numbers_.size());
      dimensions_.push_back({{.length = 1}, false});
    }
  if (numbers_.size() != dimensions_.size())
    throw SceneError("parameters", "expected names that no other parameter or point has");
}

std::size_t GivenNames::find(const std::string& name, std::string_view also) const {
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) return found->second;
  if (point_index(mechanism_, name) >= 0)
    throw ExpressionError("expected a coordinate of the point: " + name + ".x, " + name + ".y or " + name +
                          ".z");
  std::vector<std::string_view> known;
  for (const auto& [each, number] : numbers_)
    known.push_back(each);
  if (!also.empty()) known.push_back(also);
  std::ranges::sort(known);
  throw ExpressionError("there is no parameter \"" + name + "\"" + unit_hint(name) +
                        did_you_mean(name, known) +
                        (known.empty() ? "" : "; expected one of " + word_list(known)));
}

std::string GivenNames::address(std::size_t number) const {
  const std::size_t parameters = mechanism_.parameters.size();
  if (number < parameters) return "parameters." + mechanism_.parameters[number].name;
  const std::size_t coordinate = number - parameters;
  return "points." + mechanism_.points[coordinate / 3].name + "." + std::to_string(coordinate % 3);
}

std::vector<Dual> GivenNames::values() const {
  std::vector<Dual> all(size());
  take_values(mechanism_, all);
  return all;
}

void GivenNames::take_values(const Mechanism& mechanism, std::span<Dual> all) {
  take_numbers(mechanism, NumberReader<double>(), all);
}

void GivenNames::take_values(const Mechanism& mechanism, const NumberRates& rates, std::span<Dual> all) {
  take_numbers(mechanism, NumberReader<Dual>(rates), all);
}

void expect_dimension(const ValueDimension& found, std::string_view unit) {
  const Dimension wanted = parse_unit(unit).value_or(Unit{}).dimension.without_angle();
  if (found.plain || found.dimension == wanted) return;
  // Most often a number was typed for one with a unit: 7500*coordinate(slide) for a torque.
  throw ExpressionError("expected " + (unit.empty() ? "a number" : std::string(unit)) + ", found " +
                        dimension_text(found.dimension) + "; a factor in " +
                        dimension_text(wanted + found.dimension * -1) + " is missing");
}

} // namespace flyball
