// The names that expressions know, each with a number: parameters, then the coordinates of points.
#pragma once

#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/number_rates.hpp"

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace flyball {

class GivenNames {
 public:
  // Keeps the mechanism. Throws SceneError for a unit that is no SI unit, and for names that are there twice.
  explicit GivenNames(const Mechanism& mechanism);

  std::size_t size() const { return dimensions_.size(); }
  std::size_t point(std::size_t point, int i) const {
    return mechanism_.parameters.size() + 3 * point + static_cast<std::size_t>(i);
  }
  bool has(const std::string& name) const { return numbers_.contains(name); }
  // Throws ExpressionError where there is none, which tells those that there are: `also` among them.
  std::size_t find(const std::string& name, std::string_view also = {}) const;
  ValueDimension dimension(std::size_t number) const { return dimensions_[number]; }
  std::string address(std::size_t number) const; // "parameters.L", "points.A.0"

  // Their values by themselves: of rate zero. Those of a mechanism with the same names, into the first of
  // `all`.
  std::vector<Dual> values() const;
  static void take_values(const Mechanism& mechanism, std::span<Dual> all);
  // The same with their rates.
  static void take_values(const Mechanism& mechanism, const NumberRates& rates, std::span<Dual> all);

 private:
  const Mechanism& mechanism_;
  std::unordered_map<std::string, std::size_t> numbers_;
  std::vector<ValueDimension> dimensions_;
};

// Throws ExpressionError where a value is not of this unit: "expected m, found kg; a factor in m/kg
// is missing".
void expect_dimension(const ValueDimension& found, std::string_view unit);

} // namespace flyball
