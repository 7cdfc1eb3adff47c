#include "app/document/measure_edits.hpp"

#include "app/document/named_edits.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/unit.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

std::vector<SceneError> mistakes_of(const Mechanism& mechanism) {
  Mistakes mistakes;
  find_measure_mistakes(mechanism, mistakes);
  return mistakes.all();
}

void check_measure_name(const Mechanism& mechanism, const std::string& name) {
  if (!is_expression_name(name))
    throw SceneError("measures." + name, "expected a name of letters, figures and _ that is no function's");
  if (free_name(mechanism, name) != name)
    throw SceneError("measures." + name, "expected a name of its own; there is a \"" + name + "\" already");
}

// Whether a measure asks of a part that is not there, or uses a name that is none.
bool is_lost(const Mechanism& mechanism, const NamedMeasure& measure) {
  Mechanism alone = mechanism;
  std::erase_if(alone.measures, [&](const NamedMeasure& each) { return each.name == measure.name; });
  for (NamedMeasure& each : alone.measures) // whatever else is wrong with them
    each.text = "0";
  alone.measures.push_back(measure);
  return !mistakes_of(alone).empty();
}

// In measures and laws, where a measure is called by name.
void replace_in_uses(Mechanism& mechanism, const std::string& name, const std::string& text) {
  for (NamedMeasure& each : mechanism.measures)
    each.text = renamed_in(each.text, name, text);
  for (Joint& joint : mechanism.joints)
    for (Formula& formula : joint.formulas)
      if (formula.key.starts_with("drive.") && parameter_index(mechanism, name) < 0)
        formula.text = renamed_in(formula.text, name, text);
}

// Of a parameter, a measure or a point's coordinate.
ValueDimension dimension_of_name(const Mechanism& mechanism, const std::string& name) {
  const auto of_unit = [](const std::string& unit) {
    return ValueDimension{parse_unit(unit).value_or(Unit{}).dimension.without_angle(), false};
  };
  if (const int i = parameter_index(mechanism, name); i >= 0)
    return of_unit(mechanism.parameters[static_cast<std::size_t>(i)].unit);
  if (const int i = measure_index(mechanism, name); i >= 0)
    return of_unit(mechanism.measures[static_cast<std::size_t>(i)].unit);
  return of_unit("m");
}

// "N m", "kg m^3/s^3".
std::string si_unit(const Dimension& dimension) {
  if (std::string usual = dimension_text(dimension); parse_unit(usual)) return usual;
  std::string text;
  const auto add = [&](std::string_view symbol, double exponent, bool below) {
    if (exponent == 0 || (exponent < 0) != below) return;
    const char* joint = !below                   ? (text.empty() ? "" : " ")
                        : text.empty()           ? "1/"
                        : text.starts_with("1/") ? " "
                                                 : "/";
    text += joint + std::string(symbol);
    if (std::abs(exponent) != 1) text += "^" + rounded_text(std::abs(exponent), 6);
  };
  for (const bool below : {false, true}) {
    add("kg", dimension.mass, below);
    add("m", dimension.length, below);
    add("s", dimension.time, below);
  }
  return text;
}

} // namespace

NamedMeasure with_expression(const Mechanism& mechanism, NamedMeasure measure, const std::string& text) {
  measure.text = text;
  try {
    const Expression expression(text, Expression::Results::allowed);
    std::vector<ValueDimension> names, results;
    for (const std::string& name : expression.names())
      names.push_back(dimension_of_name(mechanism, name));
    for (const ResultCall& call : expression.results()) {
      const std::string_view unit = result_unit(find_quantity(mechanism, call));
      results.push_back({parse_unit(unit).value_or(Unit{}).dimension.without_angle(), false});
    }
    const ValueDimension found = expression.dimension(names, results);
    const auto fits = [&](std::string_view unit) {
      const std::optional<Unit> read = parse_unit(unit);
      return read && read->dimension.without_angle() == found.dimension;
    };
    if (found.plain || fits(measure.unit)) return measure;
    const std::string first(expression.results().empty() ? "" : result_unit(mechanism, text));
    for (const std::string& unit : {first, std::string(), si_unit(found.dimension)})
      if (fits(unit)) {
        measure.unit = unit;
        break;
      }
  } catch (const ExpressionError&) { // told where it is set
  }
  return measure;
}

void set_measure(Mechanism& mechanism, const std::string& name, const NamedMeasure& measure) {
  Mechanism next = mechanism;
  const int index = measure_index(next, name);
  if (name != measure.name) check_measure_name(next, measure.name);
  if (index < 0) {
    next.measures.push_back(measure);
  } else {
    next.measures[static_cast<std::size_t>(index)] = measure;
    if (name != measure.name) replace_in_uses(next, name, measure.name);
  }
  // Only its own mistakes: others may be being mended.
  for (const SceneError& error : mistakes_of(next))
    if (error.where() == "measures." + measure.name || error.where() == "measures." + measure.name + ".unit")
      throw error;
  mechanism = std::move(next);
}

std::string measure_mistake(const Mechanism& mechanism, const std::string& name,
                            const NamedMeasure& measure) {
  try {
    Mechanism copy = mechanism;
    set_measure(copy, name, measure);
    return {};
  } catch (const SceneError& error) {
    return error.expected();
  }
}

void remove_measure(Mechanism& mechanism, const std::string& name) {
  const int index = measure_index(mechanism, name);
  if (index < 0) throw SceneError("measures." + name, "there is no such measure");
  replace_in_uses(mechanism, name, "(" + mechanism.measures[static_cast<std::size_t>(index)].text + ")");
  mechanism.measures.erase(mechanism.measures.begin() + index);
}

void follow_in_measures(Mechanism& mechanism, const Part& part, const std::string& name) {
  const ResultPart kind = part.kind == PartKind::joint   ? ResultPart::joint
                          : part.kind == PartKind::force ? ResultPart::force
                                                         : ResultPart::body;
  for (NamedMeasure& each : mechanism.measures)
    each.text = part_renamed_in(each.text, kind, part.name, name);
  for (Joint& joint : mechanism.joints)
    for (Formula& formula : joint.formulas)
      if (is_drive_law(mechanism, formula))
        formula.text = part_renamed_in(formula.text, kind, part.name, name);
}

void drop_lost_measures(Mechanism& mechanism) {
  for (bool dropped = !mechanism.measures.empty(); dropped;) {
    dropped = std::erase_if(mechanism.measures,
                            [all = mechanism](const NamedMeasure& each) { return is_lost(all, each); }) > 0;
  }
}

NamedMeasure new_measure(const Mechanism& mechanism) {
  if (mechanism.bodies.empty()) return {free_name(mechanism, "mass_of_all"), "", "mass()", "kg"};
  const std::string body = argument_text(mechanism.bodies.back().name);
  return {free_name(mechanism, "height"), "", "y(" + body + ")", "m"};
}

} // namespace flyball
