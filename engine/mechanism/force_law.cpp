#include "engine/mechanism/force_law.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/given_names.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

const Formula* formula_of(const Formulas& formulas, std::string_view key) {
  const auto found = std::ranges::find(formulas, key, &Formula::key);
  return found == formulas.end() ? nullptr : &*found;
}

// Reads a law, expects its dimension to fit and then what `check` does, given its numbers.
template <class Check>
void check_law(const Mechanism& mechanism, const Formula& formula, std::string_view variable,
               std::string_view variable_unit, std::string_view unit, const std::string& where,
               const Check& check) {
  try {
    if (parameter_index(mechanism, variable) >= 0)
      throw ExpressionError("expected no parameter called " + std::string(variable) +
                            ", which is what it is given by here");
    const ForceLaw law(formula.text, variable);
    const GivenNames known(mechanism);
    std::vector<ValueDimension> names;
    for (const std::string& name : law.expression().names())
      names.push_back(name == variable
                          ? ValueDimension{parse_unit(variable_unit)->dimension.without_angle(), false}
                          : known.dimension(known.find(name, variable)));
    expect_dimension(law.expression().dimension(names), unit);
    std::vector<Dual> numbers;
    read_named(mechanism, law.names(), NumberReader<double>(), numbers);
    check([&](Dual x) { return law(numbers, x); });
  } catch (const ExpressionError& error) {
    throw SceneError(where, "\"=" + formula.text + "\": " + error.what());
  }
}

template <class Law>
double force_at_zero(const Law& law, std::string_view variable) {
  const double force = law(0).value;
  if (!std::isfinite(force))
    throw ExpressionError("expected a finite force at a " + std::string(variable) + " of 0");
  return force;
}

void check_coefficient(const Mechanism& mechanism, const Formula& formula, bool drag,
                       const std::string& where) {
  check_law(mechanism, formula, air_variable, "rad", "", where, [&](const auto& law) {
    constexpr int degrees = 5; // between places that are looked at
    for (int at = -180; at <= 180; at += degrees) {
      const double c = law(at * std::numbers::pi / 180).value;
      const std::string place = " at an incidence of " + std::to_string(at) + " deg";
      if (!std::isfinite(c)) throw ExpressionError("expected a finite coefficient" + place);
      if (drag && c < 0)
        throw ExpressionError("expected a drag of zero or more, found " + number_text(c) + place);
    }
    const double before = law(-std::numbers::pi).value, after = law(std::numbers::pi).value;
    constexpr double round_off = 1e-9;
    if (std::abs(after - before) > round_off * (1 + std::abs(before)))
      throw ExpressionError("expected the same at incidences of -180 and 180 deg, where the flow comes from "
                            "behind, found " +
                            rounded_text(before, 4) + " and " + rounded_text(after, 4) +
                            "; a table goes on straight beyond its ends, so it has to go all round");
  });
}

} // namespace

bool is_force_law(const Formula& formula) {
  const std::string_view key = formula.key;
  return key == "force" || key == "lift" || key == "drag" || key == "damping_force" ||
         key.starts_with("damping_force.") || (key.starts_with("spring.") && key.ends_with(".force"));
}

const Formula* spring_law(const Joint& joint, int i) {
  if (joint.formulas.empty()) return nullptr;
  return formula_of(joint.formulas, coordinate_key(joint, static_cast<std::size_t>(i), "spring") + ".force");
}

const Formula* damper_law(const Joint& joint, int i) {
  if (joint.formulas.empty()) return nullptr;
  return formula_of(joint.formulas, coordinate_key(joint, static_cast<std::size_t>(i), "damping_force"));
}

const Formula* spring_law(const Force& force) {
  return force.force ? formula_of(force.formulas, "force") : nullptr;
}

const Formula* damper_law(const Force& force) {
  return force.damping_force ? formula_of(force.formulas, "damping_force") : nullptr;
}

const Formula* lift_law(const Force& vane) {
  return vane.lift ? formula_of(vane.formulas, "lift") : nullptr;
}

const Formula* drag_law(const Force& vane) {
  return vane.drag ? formula_of(vane.formulas, "drag") : nullptr;
}

ForceLaw::ForceLaw(std::string_view text, std::string_view variable)
    : expression_(text, Expression::Results::allowed) {
  if (!expression_.results().empty()) {
    const ResultCall& call = expression_.results().front();
    throw ExpressionError("column " + std::to_string(call.begin + 1) + ": expected no results, as " +
                          std::string(result_function(call.result).name) + "() is: it is given by the " +
                          std::string(variable) + " alone");
  }
  const std::vector<std::string>& all = expression_.names();
  if (all.size() > most_names) throw ExpressionError("expected a simpler expression");
  variable_ = static_cast<std::size_t>(std::ranges::find(all, variable) - all.begin());
  std::ranges::copy_if(all, std::back_inserter(names_), [&](const auto& name) { return name != variable; });
}

Dual ForceLaw::operator()(std::span<const Dual> numbers, Dual x) const {
  std::array<Dual, most_names> values;
  for (std::size_t i = 0, next = 0; i < expression_.names().size(); ++i)
    values[i] = i == variable_ ? x : numbers[next++];
  return expression_.evaluate(values);
}

void check_spring_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where) {
  check_law(mechanism, law, spring_variable, fields::value_unit(angle), fields::force_unit(angle), where,
            [](const auto& force) { force_at_zero(force, spring_variable); });
}

void check_damper_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where) {
  check_law(mechanism, law, damper_variable, fields::speed_unit(angle), fields::force_unit(angle), where,
            [](const auto& force) {
              const double at_rest = force_at_zero(force, damper_variable);
              constexpr double round_off = 1e-12;
              const double size = std::max(std::abs(force(1).value), std::abs(force(-1).value));
              if (std::abs(at_rest) > round_off * size)
                throw ExpressionError("expected no force at a rate of 0, where a damper rests; found " +
                                      number_text(at_rest));
              if (!std::isfinite(force({0, 1}).rate))
                throw ExpressionError("expected a finite slope at a rate of 0, where it is the damping");
            });
}

void check_lift_law(const Mechanism& mechanism, const Formula& law, const std::string& where) {
  check_coefficient(mechanism, law, false, where);
}

void check_drag_law(const Mechanism& mechanism, const Formula& law, const std::string& where) {
  check_coefficient(mechanism, law, true, where);
}

} // namespace flyball
