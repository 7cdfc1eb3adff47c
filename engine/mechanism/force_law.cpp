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

namespace flyball {
namespace {

const Formula* formula_of(const Formulas& formulas, std::string_view key) {
  const auto found = std::ranges::find(formulas, key, &Formula::key);
  return found == formulas.end() ? nullptr : &*found;
}

// By name of the law.
std::vector<Dual> numbers_of(const Mechanism& mechanism, const ForceLaw& law) {
  std::vector<Dual> numbers;
  for (const std::string& name : law.names())
    numbers.push_back(named_number(mechanism, name));
  return numbers;
}

void check_dimension(const Mechanism& mechanism, const ForceLaw& law, std::string_view variable,
                     std::string_view variable_unit, bool angle) {
  const GivenNames known(mechanism);
  std::vector<ValueDimension> names;
  for (const std::string& name : law.expression().names())
    names.push_back(name == variable
                        ? ValueDimension{parse_unit(variable_unit)->dimension.without_angle(), false}
                        : known.dimension(known.find(name)));
  expect_dimension(law.expression().dimension(names), fields::force_unit(angle));
}

void check_law(const Mechanism& mechanism, const Formula& formula, std::string_view variable, bool angle,
               const std::string& where) {
  const bool damper = variable == damper_variable;
  try {
    if (parameter_index(mechanism, variable) >= 0)
      throw ExpressionError("expected no parameter called " + std::string(variable) +
                            ", which is what the force is given by here");
    const ForceLaw law(formula.text, variable);
    check_dimension(mechanism, law, variable, damper ? fields::speed_unit(angle) : fields::value_unit(angle),
                    angle);
    const std::vector<Dual> numbers = numbers_of(mechanism, law);
    const double at_zero = law(numbers, 0).value;
    if (!std::isfinite(at_zero))
      throw ExpressionError("expected a finite force at a " + std::string(variable) + " of 0");
    if (!damper) return;
    constexpr double round_off = 1e-12;
    const double size = std::max(std::abs(law(numbers, 1).value), std::abs(law(numbers, -1).value));
    if (std::abs(at_zero) > round_off * size)
      throw ExpressionError("expected no force at a rate of 0, where a damper rests; found " +
                            number_text(at_zero));
  } catch (const ExpressionError& error) {
    throw SceneError(where, "\"=" + formula.text + "\": " + error.what());
  }
}

} // namespace

bool is_force_law(const Formula& formula) {
  const std::string_view key = formula.key;
  return key == "force" || key == "damping_force" || key.starts_with("damping_force.") ||
         (key.starts_with("spring.") && key.ends_with(".force"));
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

ForceLaw::ForceLaw(std::string_view text, std::string_view variable) : expression_(text) {
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
  check_law(mechanism, law, spring_variable, angle, where);
}

void check_damper_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where) {
  check_law(mechanism, law, damper_variable, angle, where);
}

bool resists_at_rest(const Formula& damper_law) {
  const ForceLaw law(damper_law.text, damper_variable);
  constexpr double near = 1e-9; // before and after a kink
  return law.names().empty() && law({}, {-near, 1}).rate >= 0 && law({}, {near, 1}).rate >= 0;
}

} // namespace flyball
