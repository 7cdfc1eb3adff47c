// The measures of a mechanism, read: which quantities of results they ask for, and what they make of them.
#pragma once

#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/number_rates.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace flyball {

class Mistakes;

// What a result function is asked of, by places in the mechanism's lists.
struct ResultQuantity {
  struct Of {
    int part = -1;      // a body (-1: the ground, or all of mass()), a joint or a force
    int coordinate = 0; // of the joint
    int point = -1;     // the named point that the body carries; -1: its mass centre
    bool operator==(const Of&) const = default;
  };
  Result result{};
  int count = 0; // of `of`
  std::array<Of, 3> of{};
  bool angle = false; // the coordinate is one
  bool operator==(const ResultQuantity&) const = default;
};

// SI: "N m" of the torque of an angle's drive.
std::string_view result_unit(const ResultQuantity& quantity);

// Throws ExpressionError where there is no such part, or where it has not what is asked for.
ResultQuantity find_quantity(const Mechanism& mechanism, const ResultCall& call);
// As an expression asks for it: "distance(ball, ground@A)".
std::string quantity_text(const Mechanism& mechanism, const ResultQuantity& quantity);

class MeasurePlan {
 public:
  MeasurePlan() = default;
  // Throws SceneError naming the first measure that is wrong, see find_measure_mistakes.
  explicit MeasurePlan(const Mechanism& mechanism);

  bool empty() const { return measures_.empty(); }
  std::size_t size() const { return measures_.size(); }
  // Each once.
  const std::vector<ResultQuantity>& quantities() const { return quantities_; }

  // Which measures rest on a quantity, themselves or through others.
  std::vector<bool> users_of(std::size_t quantity) const;

  // Whether it says the same of this mechanism, whose parts are the same.
  bool fits(const Mechanism& mechanism) const;
  // Takes the values of parameters and points.
  void set_numbers(const Mechanism& mechanism);
  // With their rates.
  void set_numbers(const Mechanism& mechanism, const NumberRates& rates);
  // All measures in the scene's order, of quantities in the order of quantities(); not finite where one is
  // undefined. No allocation.
  void evaluate(std::span<const Dual> quantities, std::span<Dual> measures);

 private:
  struct Compiled {
    Expression expression;
    std::vector<std::size_t> names, results; // in values_ and quantities_
  };
  friend class MeasureCompiler;

  std::vector<NamedMeasure> texts_;
  std::vector<std::string> parameters_, points_; // names, as they were
  std::vector<Compiled> measures_;               // in the scene's order
  std::vector<std::size_t> order_;               // in which each rests on those before it
  std::vector<ResultQuantity> quantities_;
  std::vector<Dual> values_; // parameters, three a point, measures
};

// All that is wrong with the measures of a mechanism whose parts and names are right: expressions that cannot
// be read, unknown names and parts, quantities that a part has not, dimensions that do not fit the unit,
// circles.
void find_measure_mistakes(const Mechanism& mechanism, Mistakes& mistakes);

// The unit of the first result that an expression asks for: that of "torque(spin)". Throws ExpressionError
// for what is no expression, asks for nothing, or for what is not there.
std::string_view result_unit(const Mechanism& mechanism, std::string_view expression);

int measure_index(const Mechanism& mechanism, std::string_view name); // -1: none

} // namespace flyball
