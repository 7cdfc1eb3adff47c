#include "app/document/named_edits.hpp"

#include "app/document/formula_change.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/measure_edits.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/numbers.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace flyball {
namespace {

template <class Visit>
void visit_formulas(Mechanism& mechanism, const Visit& visit) {
  const auto all = [&](auto& parts) {
    for (auto& part : parts)
      visit(part.formulas);
  };
  all(mechanism.parameters);
  all(mechanism.points);
  visit(mechanism.formulas);
  all(mechanism.bodies);
  for (Body& body : mechanism.bodies)
    all(body.shapes);
  all(mechanism.joints);
  all(mechanism.forces);
}

void check_name(const Mechanism& mechanism, const std::string& name, const std::string& where) {
  if (!is_expression_name(name))
    throw SceneError(where, "expected a name of letters, figures and _ that is no function's");
  if (free_name(mechanism, name) != name)
    throw SceneError(where, "expected a name of its own; there is a \"" + name + "\" already");
}

template <class Named>
void rename_in(Mechanism& mechanism, std::vector<Named>& list, int index, const std::string& list_name,
               const std::string& to) {
  if (index < 0) throw SceneError(list_name, "there is no such name");
  const std::string from = list[static_cast<std::size_t>(index)].name, path = list_name + "." + from;
  if (to == from) return;
  check_name(mechanism, to, path);
  list[static_cast<std::size_t>(index)].name = to;
  visit_formulas(mechanism, [&](Formulas& formulas) {
    for (Formula& formula : formulas)
      formula.text = renamed_in(formula.text, from, to);
  });
  for (NamedMeasure& measure : mechanism.measures)
    measure.text = renamed_in(measure.text, from, to);
  for (Slider& slider : mechanism.sliders)
    if (slider.parameter == path || slider.parameter.starts_with(path + "."))
      slider.parameter.replace(0, path.size(), list_name + "." + to);
}

void forget(Mechanism& mechanism, const std::string& name, const std::string& path) {
  // One number of a rotation alone says nothing.
  for (Body& body : mechanism.bodies)
    if (std::ranges::any_of(body.formulas, [&](const Formula& formula) {
          return formula.key.starts_with("rotation.") && mentions(formula.text, name);
        }))
      forget_rotation(body.formulas);
  visit_formulas(mechanism, [&](Formulas& formulas) {
    std::erase_if(formulas, [&](const Formula& formula) { return mentions(formula.text, name); });
  });
  std::erase_if(mechanism.sliders, [&](const Slider& slider) {
    return slider.parameter == path || slider.parameter.starts_with(path + ".");
  });
}

// Calls with every law (drive_law.hpp, force_law.hpp) that names it, and the address of its number.
template <class Visit>
void visit_laws(Mechanism& mechanism, const std::string& name, const Visit& visit) {
  std::vector<std::pair<std::string, Formula*>> laws;
  const auto collect = [&](const std::string& list, auto& parts) {
    for (auto& part : parts)
      for (Formula& formula : part.formulas)
        if ((is_drive_law(mechanism, formula) || is_force_law(formula)) && mentions(formula.text, name))
          laws.emplace_back(list + part.name + "." + formula.key, &formula);
  };
  collect("joints.", mechanism.joints);
  collect("forces.", mechanism.forces);
  for (const auto& [address, formula] : laws)
    visit(address, *formula);
}

} // namespace

void name_place(Mechanism& mechanism, const std::string& vector, const std::string& name) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    check_name(next, name, "points." + name);
    NamedPoint point;
    point.name = name;
    for (const int i : {0, 1, 2}) {
      const std::string address = vector + "." + std::to_string(i);
      point.at[i] = expressed_value(next, address);
      if (const std::optional<std::string> formula = expression_at(next, address))
        point.formulas.push_back({std::to_string(i), *formula});
    }
    next.points.push_back(std::move(point));
    for (const int i : {0, 1, 2})
      put_expression(next, vector + "." + std::to_string(i), point_coordinate(name, i));
  });
}

void name_number(Mechanism& mechanism, const std::string& address, const std::string& name) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    check_name(next, name, "parameters." + name);
    NamedParameter parameter;
    parameter.name = name;
    parameter.value = expressed_value(next, address);
    parameter.unit = expressed_unit(next, address);
    if (const std::optional<std::string> formula = expression_at(next, address))
      parameter.formulas = {{"value", *formula}};
    next.parameters.push_back(std::move(parameter));
    put_expression(next, address, name);
    // A slider of the number is one of the parameter.
    for (Slider& slider : next.sliders)
      if (slider.parameter == address) slider.parameter = "parameters." + name;
  });
}

namespace {

// The value of the last parameter, now 1, with which an expression that is linear in it gives the number this
// value; 1 where there is none above zero.
double value_that_keeps(const Mechanism& with_one, const std::string& address, double wanted) {
  const auto given = [&](double value) {
    Mechanism tried = with_one;
    tried.parameters.back().value = value;
    evaluate_formulas(tried);
    return expressed_value(tried, address);
  };
  try {
    const double one = given(1), two = given(2), slope = two - one;
    if (!(std::abs(given(3) - two - slope) <= 1e-9 * std::abs(slope))) return 1;
    const double value = std::strtod(rounded_text(1 + (wanted - one) / slope, 12).c_str(), nullptr);
    // It may be linear between these three alone, as a largest of two is.
    const bool keeps =
        std::isfinite(value) && value > 0 &&
        std::abs(given(value) - wanted) <= 1e-9 * std::max(std::abs(wanted), std::abs(slope * value));
    return keeps ? value : 1;
  } catch (const SceneError&) { // it is not to be one of these
    return 1;
  }
}

} // namespace

std::optional<NamedParameter> lacking_parameter(const Mechanism& mechanism, const std::string& address,
                                                const std::string& text) {
  constexpr std::array usual{"",    "m",   "kg",    "s",     "rad/s",  "m/s",    "N",
                             "N m", "N/m", "N s/m", "N m s", "kg m^2", "kg/m^3", "1/m"};
  constexpr std::array variables{spring_variable, damper_variable, air_variable};
  NamedParameter lacking;
  bool law = false; // of the state: it has no value yet
  try {
    const Expression expression(text, Expression::Results::allowed);
    law = !expression.results().empty();
    for (const std::string& name : expression.names()) {
      law = law || std::ranges::find(variables, name) != variables.end();
      if (!is_expression_name(name) || free_name(mechanism, name) != name ||
          std::ranges::find(variables, name) != variables.end())
        continue;
      // Who writes a joint's name means where the joint is, not a number of the scene.
      if (!lacking.name.empty() || joint_index(mechanism, name) >= 0) return {};
      lacking.name = name;
    }
  } catch (const ExpressionError&) {
    return {};
  }
  if (lacking.name.empty()) return {};
  std::string alone = text;
  std::erase(alone, ' ');
  const double present = expressed_value(mechanism, address);
  lacking.value = alone == lacking.name ? present : 1;
  std::vector<std::string> units(usual.begin(), usual.end());
  units.insert(units.begin(), expressed_unit(mechanism, address));
  for (const std::string& unit : units) {
    lacking.unit = unit;
    try {
      Mechanism tried = mechanism;
      tried.parameters.push_back(lacking);
      set_expression(tried, address, text);
      if (!law && alone != lacking.name) lacking.value = value_that_keeps(tried, address, present);
      return lacking;
    } catch (const SceneError&) { // of another dimension
    }
  }
  return {};
}

std::string free_name(const Mechanism& mechanism, const std::string& wish) {
  std::string name = wish;
  const auto taken = [&] {
    return parameter_index(mechanism, name) >= 0 || point_index(mechanism, name) >= 0 ||
           measure_index(mechanism, name) >= 0;
  };
  for (int i = 2; taken(); ++i)
    name = wish + std::to_string(i);
  return name;
}

void rename_parameter(Mechanism& mechanism, const std::string& name, const std::string& to) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    rename_in(next, next.parameters, parameter_index(next, name), "parameters", to);
  });
}

void rename_point(Mechanism& mechanism, const std::string& name, const std::string& to) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    rename_in(next, next.points, point_index(next, name), "points", to);
  });
}

void remove_parameter(Mechanism& mechanism, const std::string& name) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    const int index = parameter_index(next, name);
    if (index < 0) return;
    const NamedParameter& parameter = next.parameters[static_cast<std::size_t>(index)];
    const std::string value =
        "(" + number_text(parameter.value) + (parameter.unit.empty() ? "" : " " + parameter.unit) + ")";
    visit_laws(next, name,
               [&](const std::string&, Formula& law) { law.text = renamed_in(law.text, name, value); });
    for (NamedMeasure& measure : next.measures)
      measure.text = renamed_in(measure.text, name, value);
    next.parameters.erase(next.parameters.begin() + index);
    forget(next, name, "parameters." + name);
  });
}

void remove_point(Mechanism& mechanism, const std::string& name) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    visit_laws(next, name, [&](const std::string& address, const Formula& law) {
      throw SceneError(address, "the law \"=" + law.text + "\" names the point " + name);
    });
    std::erase_if(next.points, [&](const NamedPoint& each) { return each.name == name; });
    forget(next, name, "points." + name);
    drop_lost_measures(next);
  });
}

std::vector<std::string> users_of(const Mechanism& mechanism, std::string_view name) {
  std::vector<std::string> users;
  for (const GivenNumber& given : given_numbers(mechanism))
    if (mentions(given.text, name)) users.push_back(given.address);
  for (const NamedMeasure& measure : mechanism.measures)
    if (mentions(measure.text, name)) users.push_back("measures." + measure.name);
  return users;
}

} // namespace flyball
