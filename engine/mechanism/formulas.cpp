#include "engine/mechanism/formulas.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/formula_plan.hpp"
#include "engine/mechanism/given_names.hpp"
#include "engine/mechanism/infinite_rate.hpp"
#include "engine/mechanism/mass_properties.hpp"
#include "engine/mechanism/numbers.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace flyball {
namespace {

constexpr std::array<std::string_view, 3> coordinate_letters{"x", "y", "z"};

template <class Part>
int index_of_named(const std::vector<Part>& parts, std::string_view name) {
  const auto found = std::ranges::find(parts, name, &Part::name);
  return found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
}

// An expression with its names found.
struct Compiled {
  Expression expression;
  std::vector<std::size_t> names; // by name of the expression

  Compiled(std::string_view text, const GivenNames& known) : expression(text) {
    for (const std::string& name : expression.names())
      names.push_back(known.find(name));
  }
  void expect_unit(std::string_view unit, const GivenNames& known) const {
    std::vector<ValueDimension> dimensions;
    for (const std::size_t name : names)
      dimensions.push_back(known.dimension(name));
    expect_dimension(expression.dimension(dimensions), unit);
  }
  Dual evaluate(const std::vector<Dual>& values) const {
    const Dual value = expression.evaluate(values, names);
    if (!std::isfinite(value.value)) throw ExpressionError("the value is not finite");
    return value;
  }
};

std::string quoted_expression(std::string_view text) {
  constexpr std::size_t longest = 60;
  return "\"=" + std::string(text.substr(0, longest)) + (text.size() > longest ? "..." : "") + "\"";
}

// Says at which place an expression is wrong.
template <class Do>
auto at_place(const std::string& where, std::string_view text, const Do& act) {
  try {
    return act();
  } catch (const ExpressionError& error) {
    throw SceneError(where, quoted_expression(text) + ": " + error.what());
  }
}

std::string joined_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

// Every part with expressions, beside parameters and points: its path, its expressions and its numbers.
using PartVisitor =
    std::function<void(const std::string&, Formulas&, const std::function<std::vector<Number>()>&)>;
void visit_parts(Mechanism& m, const PartVisitor& visit) {
  if (!m.formulas.empty())
    visit("", m.formulas, [&] {
      std::vector<Number> all = numbers_of_gravity(m.gravity);
      std::ranges::move(numbers_of(m.air), std::back_inserter(all));
      std::ranges::move(numbers_of(m.simulation), std::back_inserter(all));
      return all;
    });
  for (Body& body : m.bodies) {
    const std::string path = "bodies." + body.name;
    if (!body.formulas.empty()) visit(path, body.formulas, [&] { return all_numbers_of(body); });
    for (std::size_t i = 0; i < body.shapes.size(); ++i)
      if (Shape& shape = body.shapes[i]; !shape.formulas.empty())
        visit(path + ".shapes." + std::to_string(i), shape.formulas,
              [&] { return all_numbers_of(shape, body); });
  }
  for (Joint& joint : m.joints)
    if (!joint.formulas.empty())
      visit("joints." + joint.name, joint.formulas, [&] { return numbers_of(m, joint); });
  for (Force& force : m.forces)
    if (!force.formulas.empty())
      visit("forces." + force.name, force.formulas, [&] { return numbers_of(m, force); });
}

// Whether there is anything to evaluate.
bool has_formulas(const Mechanism& m) {
  const auto given = [](const auto& part) { return !part.formulas.empty(); };
  return given(m) || !m.parameters.empty() || !m.points.empty() || std::ranges::any_of(m.joints, given) ||
         std::ranges::any_of(m.forces, given) || std::ranges::any_of(m.bodies, [&](const Body& body) {
           return body.density || given(body) || std::ranges::any_of(body.shapes, given);
         });
}

// A dependent parameter or point's coordinate.
struct Definition {
  std::size_t name;
  std::string where, text;
  std::string unit;
  double* place;
  Compiled compiled;
};

std::vector<Definition> definitions_of(Mechanism& m, const GivenNames& names) {
  std::vector<Definition> all;
  const auto define = [&](std::size_t name, const std::string& where, const std::string& text,
                          std::string unit, double& place) {
    at_place(where, text, [&] {
      all.push_back({name, where, text, std::move(unit), &place, Compiled(text, names)});
      all.back().compiled.expect_unit(all.back().unit, names);
    });
  };
  for (std::size_t i = 0; i < m.parameters.size(); ++i)
    for (const Formula& formula : m.parameters[i].formulas) {
      const std::string where = "parameters." + m.parameters[i].name;
      if (formula.key != "value") throw SceneError(where + "." + formula.key, "expected no expression here");
      define(i, where, formula.text, m.parameters[i].unit, m.parameters[i].value);
    }
  for (std::size_t p = 0; p < m.points.size(); ++p)
    for (const Formula& formula : m.points[p].formulas) {
      const int i = std::clamp(std::atoi(formula.key.c_str()), 0, 2);
      define(names.point(p, i), "points." + m.points[p].name + "[" + std::to_string(i) + "]", formula.text,
             "m", m.points[p].at[i]);
    }
  return all;
}

// In an order in which each rests on those before it (Kahn 1962).
std::vector<const Definition*> in_order(const std::vector<Definition>& all, std::size_t names) {
  std::vector<const Definition*> of_name(names, nullptr);
  for (const Definition& each : all)
    of_name[each.name] = &each;
  const auto rests_on = [&](const Definition& each) {
    std::vector<std::size_t> on;
    for (const std::size_t name : each.compiled.names)
      if (of_name[name] != nullptr) on.push_back(name);
    return on;
  };
  std::vector<std::size_t> open(names, 0);
  std::vector<std::vector<const Definition*>> users(names);
  std::vector<const Definition*> order;
  for (const Definition& each : all) {
    for (const std::size_t name : rests_on(each))
      users[name].push_back(&each);
    open[each.name] = rests_on(each).size();
    if (open[each.name] == 0) order.push_back(&each);
  }
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const Definition* user : users[order[i]->name])
      if (--open[user->name] == 0) order.push_back(user);
  if (order.size() == all.size()) return order;
  // Following what is open leads into a circle.
  const Definition* at = &*std::ranges::find_if(all, [&](const Definition& d) { return open[d.name] > 0; });
  std::vector<const Definition*> path;
  while (std::ranges::find(path, at) == path.end()) {
    path.push_back(at);
    for (const std::size_t name : rests_on(*at))
      if (open[name] > 0) {
        at = of_name[name];
        break;
      }
  }
  std::string circle;
  for (auto it = std::ranges::find(path, at); it != path.end(); ++it)
    circle += (*it)->where + ", ";
  throw SceneError(at->where, "\"=" + at->text +
                                  "\": expected no circle of expressions; this one goes through " + circle +
                                  "and back");
}

// Mass, mass centre and inertia by the density, to the same digits whatever they were before. False where the
// shapes have no volume.
bool weigh(Body& body) {
  std::optional<Vec3> reference;
  for (Shape& shape : body.shapes) {
    const bool rod = is_rod(shape.type);
    if (!rod && !shape.at) shape.at = body.position;
    if (!reference) reference = rod ? shape.from : *shape.at;
  }
  if (reference) body.position = *reference;
  return take_mass_properties(body, *body.density);
}

} // namespace

// What expressions give, with its place; the definitions of names come first.
struct FormulaPlan::State {
  struct Assignment {
    std::string where, text;
    Compiled compiled;
    const void* place; // see NumberRates
    std::function<void(double)> set;
    std::optional<std::size_t> name; // that it defines
    double result = 0;               // of the last evaluation
  };
  Mechanism& mechanism;
  std::vector<Assignment> assignments;
  std::vector<Dual> values; // of the names
  // The same after evaluate_names(), where that came to its end: while they stay, so do all results.
  std::vector<double> evaluated;
  bool is_evaluated = false;

  explicit State(Mechanism& m) : mechanism(m) {
    const GivenNames names(m);
    values.resize(names.size());
    evaluated.reserve(values.size());
    const std::vector<Definition> definitions = definitions_of(m, names);
    for (const Definition* each : in_order(definitions, names.size()))
      assignments.push_back({each->where, each->text, each->compiled, place_of(*each->place),
                             [place = each->place](double value) { *place = value; }, each->name});
    visit_parts(m, [&](const std::string& path, const Formulas& formulas, const auto& numbers_of_part) {
      const std::vector<Number> numbers = numbers_of_part();
      for (const Formula& formula : formulas) {
        if (is_drive_law(m, formula) || is_force_law(formula)) continue; // has a value at each state
        const std::string where = joined_path(path, formula.key);
        const auto number = std::ranges::find(numbers, formula.key, &Number::key);
        if (number == numbers.end())
          throw SceneError(where, "\"=" + formula.text + "\": there is no such number");
        at_place(where, formula.text, [&] {
          Compiled compiled(formula.text, names);
          compiled.expect_unit(number->unit, names);
          assignments.push_back({where, formula.text, std::move(compiled), number->place, number->set, {}});
        });
      }
    });
  }

  void differentiate(NumberRates& rates) {
    GivenNames::take_values(mechanism, rates, values);
    for (const Assignment& each : assignments) {
      const Dual value = at_place(each.where, each.text, [&] { return each.compiled.evaluate(values); });
      if (!std::isfinite(value.rate))
        throw InfiniteRate(each.where, quoted_expression(each.text) + ": the rate of change is not finite");
      if (each.name) values[*each.name] = value;
      if (value.rate != 0) rates.set(each.place, value.rate);
    }
    for (const Body& body : mechanism.bodies)
      if (body.density) take_mass_rates(body, rates);
  }

  void evaluate_names() {
    is_evaluated = false;
    evaluated.clear();
    for (Assignment& each : assignments) {
      const Dual value = at_place(each.where, each.text, [&] { return each.compiled.evaluate(values); });
      if (each.name) values[*each.name] = value;
      each.result = value.value;
      each.set(each.result);
    }
    for (const Dual& value : values)
      evaluated.push_back(value.value);
    is_evaluated = true;
  }

  void evaluate() {
    GivenNames::take_values(mechanism, values);
    if (!is_evaluated || !std::ranges::equal(values, evaluated, {}, &Dual::value))
      evaluate_names();
    else
      for (const Assignment& each : assignments)
        each.set(each.result);
    for (Body& body : mechanism.bodies)
      if (body.density && !weigh(body))
        throw SceneError(
            "bodies." + body.name + ".density",
            "expected shapes with a volume and a density above zero, from which the mass follows");
  }
};

FormulaPlan::FormulaPlan(Mechanism& mechanism)
    : state_(has_formulas(mechanism) ? std::make_unique<State>(mechanism) : nullptr) {}
FormulaPlan::~FormulaPlan() = default;
FormulaPlan::FormulaPlan(FormulaPlan&&) noexcept = default;
FormulaPlan& FormulaPlan::operator=(FormulaPlan&&) noexcept = default;

void FormulaPlan::evaluate() {
  if (state_) state_->evaluate();
}

void FormulaPlan::differentiate(NumberRates& rates) const {
  if (state_) state_->differentiate(rates);
}

void evaluate_formulas(Mechanism& mechanism) {
  FormulaPlan(mechanism).evaluate();
}

FormulaPlace formula_place(Mechanism& mechanism, std::string_view address) {
  const auto next = [&address] {
    const std::string_view segment = address.substr(0, address.find('.'));
    address.remove_prefix(std::min(address.size(), segment.size() + 1));
    return segment;
  };
  const std::string_view whole = address, list = next();
  if (list == "gravity" || list == "air" || list == "simulation") return {&mechanism.formulas, whole};
  const std::string_view name = next();
  const auto of = [&](auto& parts) -> FormulaPlace {
    const int i = index_of_named(parts, name);
    if (i < 0) return {};
    return {&parts[static_cast<std::size_t>(i)].formulas, address};
  };
  if (list == "parameters") {
    address = "value";
    return of(mechanism.parameters);
  }
  if (list == "points") return of(mechanism.points);
  if (list == "joints") return of(mechanism.joints);
  if (list == "forces") return of(mechanism.forces);
  if (list != "bodies") return {};
  if (!address.starts_with("shapes.")) return of(mechanism.bodies);
  const int i = index_of_named(mechanism.bodies, name);
  if (i < 0) return {};
  next();
  std::vector<Shape>& shapes = mechanism.bodies[static_cast<std::size_t>(i)].shapes;
  const auto shape = static_cast<std::size_t>(std::max(std::atoi(std::string(next()).c_str()), 0));
  if (shape >= shapes.size()) return {};
  return {&shapes[shape].formulas, address};
}

Number expressible_number(Mechanism& mechanism, std::string_view address) {
  const auto [formulas, key] = formula_place(mechanism, address);
  const auto number = [&key = key](std::vector<Number> numbers) -> std::optional<Number> {
    const auto found = std::ranges::find(numbers, key, &Number::key);
    return found == numbers.end() ? std::nullopt : std::optional(std::move(*found));
  };
  for (Body& body : mechanism.bodies) {
    if (&body.formulas == formulas && key.starts_with("rotation."))
      if (auto entry = number(all_numbers_of(body))) return std::move(*entry);
    for (Shape& shape : body.shapes)
      if (&shape.formulas == formulas)
        if (auto size = number(all_numbers_of(shape, body))) return std::move(*size);
  }
  return addressed_number(mechanism, address);
}

std::optional<std::string> formula_at(const Mechanism& mechanism, std::string_view address) {
  // Only looked at.
  const auto [formulas, key] = formula_place(const_cast<Mechanism&>(mechanism), address);
  if (!formulas) return {};
  const auto found = std::ranges::find(*formulas, key, &Formula::key);
  return found == formulas->end() ? std::nullopt : std::optional(found->text);
}

std::vector<GivenNumber> given_numbers(const Mechanism& mechanism) {
  std::vector<GivenNumber> all;
  if (!has_formulas(mechanism)) return all;
  for (const NamedParameter& parameter : mechanism.parameters)
    for (const Formula& formula : parameter.formulas) {
      const std::string address = "parameters." + parameter.name;
      all.push_back({address, address, formula.text, parameter.value, parameter.unit});
    }
  for (const NamedPoint& point : mechanism.points)
    for (const Formula& formula : point.formulas) {
      const std::string part = "points." + point.name;
      all.push_back({part, joined_path(part, formula.key), formula.text,
                     point.at[std::clamp(std::atoi(formula.key.c_str()), 0, 2)], "m"});
    }
  Mechanism copy = mechanism;
  visit_parts(copy, [&](const std::string& path, const Formulas& formulas, const auto& numbers_of_part) {
    const std::vector<Number> numbers = numbers_of_part();
    for (const Formula& formula : formulas)
      if (is_force_law(formula)) // no number
        continue;
      else if (const auto number = std::ranges::find(numbers, formula.key, &Number::key);
               number != numbers.end())
        all.push_back({path, joined_path(path, formula.key), formula.text, number->value, number->unit});
  });
  return all;
}

void drop_lost_formulas(Mechanism& mechanism) {
  visit_parts(mechanism, [](const std::string&, Formulas& formulas, const auto& numbers_of_part) {
    const std::vector<Number> numbers = numbers_of_part();
    std::erase_if(formulas, [&](const Formula& formula) {
      return std::ranges::find(numbers, formula.key, &Number::key) == numbers.end();
    });
  });
}

std::vector<std::string> sources_of(const Mechanism& mechanism, std::string_view expression) {
  std::vector<std::string> sources;
  try {
    Mechanism copy = mechanism;
    const GivenNames names(copy);
    const std::vector<Definition> definitions = definitions_of(copy, names);
    in_order(definitions, names.size()); // no circles
    const auto add = [&](const auto& self, const Compiled& compiled) -> void {
      for (const std::size_t name : compiled.names) {
        const auto definition = std::ranges::find(definitions, name, &Definition::name);
        if (definition != definitions.end())
          self(self, definition->compiled);
        else if (std::ranges::find(sources, names.address(name)) == sources.end())
          sources.push_back(names.address(name));
      }
    };
    add(add, Compiled(expression, names));
  } catch (const SceneError&) {
    return {};
  } catch (const ExpressionError&) {
    return {};
  }
  return sources;
}

std::vector<double> expression_gradient(const Mechanism& mechanism, std::string_view expression,
                                        const std::vector<std::string>& sources) {
  Mechanism copy = mechanism;
  const GivenNames names(copy);
  const std::vector<Definition> definitions = definitions_of(copy, names);
  const std::vector<const Definition*> order = in_order(definitions, names.size());
  return at_place("", expression, [&] {
    const Compiled compiled(expression, names);
    std::vector<double> gradient;
    for (const std::string& source : sources) {
      std::vector<Dual> values = names.values();
      for (std::size_t name = 0; name < names.size(); ++name)
        values[name].rate = names.address(name) == source ? 1 : 0;
      for (const Definition* each : order)
        values[each->name] = each->compiled.evaluate(values);
      gradient.push_back(compiled.evaluate(values).rate);
    }
    return gradient;
  });
}

double evaluate_expression(const Mechanism& mechanism, std::string_view expression, std::string_view unit,
                           const std::string& where) {
  const GivenNames names(mechanism);
  return at_place(where, expression, [&] {
    const Compiled compiled(expression, names);
    compiled.expect_unit(unit, names);
    return compiled.evaluate(names.values()).value;
  });
}

std::string point_coordinate(std::string_view point, int i) {
  return std::string(point) + "." + std::string(coordinate_letters[static_cast<std::size_t>(i)]);
}

int parameter_index(const Mechanism& mechanism, std::string_view name) {
  return index_of_named(mechanism.parameters, name);
}

int point_index(const Mechanism& mechanism, std::string_view name) {
  return index_of_named(mechanism.points, name);
}

std::string used_of_version_2(const Mechanism& mechanism) {
  const auto first = [](const auto& part, const std::string& path) {
    return part.formulas.empty() ? "" : joined_path(path, part.formulas.front().key);
  };
  if (!mechanism.parameters.empty()) return "parameters";
  if (!mechanism.points.empty()) return "points";
  if (!mechanism.measures.empty()) return "measures";
  if (!mechanism.formulas.empty()) return first(mechanism, "");
  if (mechanism.air != Air()) return "air";
  for (const Body& body : mechanism.bodies) {
    const std::string path = "bodies." + body.name;
    if (body.density) return path + ".density";
    if (!body.formulas.empty()) return first(body, path);
    for (const Shape& shape : body.shapes)
      if (!shape.formulas.empty()) return first(shape, path + ".shapes");
  }
  for (const Joint& joint : mechanism.joints) {
    if (!joint.formulas.empty()) return first(joint, "joints." + joint.name);
    if (joint.kind != GearKind::gear) return "joints." + joint.name + ".kind";
    for (const Coordinate& c : joint.coordinates) {
      if (c.drive && (c.drive->load || finds_speed(*c.drive)))
        return "joints." + joint.name +
               (finds_speed(*c.drive) && !c.drive->torque ? ".drive.keeps" : ".drive.torque");
      if (c.friction) return "joints." + joint.name + ".friction";
      if (c.spring && c.spring->force) return "joints." + joint.name + ".spring.force";
      if (c.damping_force) return "joints." + joint.name + ".damping_force";
    }
  }
  for (const Force& force : mechanism.forces)
    if (!force.formulas.empty())
      return first(force, "forces." + force.name);
    else if (force.force || force.damping_force || force.type == ForceType::bearing ||
             force.type == ForceType::vane)
      return "forces." + force.name;
  return {};
}

} // namespace flyball
