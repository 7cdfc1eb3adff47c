#include "app/document/formula_edits.hpp"

#include "app/document/measure_edits.hpp"
#include "app/document/turns.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/numbers.hpp"
#include "engine/mechanism/text.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

namespace flyball {
namespace {

// Sets every number whose expression has a value, and returns how many have none. (Laws of a state are among
// these, before and after an edit.)
std::size_t evaluate_what_can_be(Mechanism& mechanism) {
  constexpr int most_passes = 64; // names rest on names
  const Mechanism before = mechanism;
  std::size_t wrong = 0;
  bool moved = true;
  for (int pass = 0; moved && pass < most_passes; ++pass) {
    moved = false;
    wrong = 0;
    for (const GivenNumber& given : given_numbers(mechanism)) {
      try {
        const double value = evaluate_expression(mechanism, given.text, given.unit, given.address);
        moved = moved || value != given.value;
        expressible_number(mechanism, given.address).set(value);
      } catch (const SceneError&) {
        ++wrong;
      }
    }
  }
  if (!moved) return wrong;
  mechanism = before; // a circle of names has no values
  return std::numeric_limits<std::size_t>::max();
}

// Takes an edit in spite of mistakes in expressions that were there before, if it makes no more of them; what
// has a value is evaluated. So mistakes can be mended one after the other, and the rest be built before that.
bool take_with_mistakes(const Mechanism& before, Mechanism& next) {
  Mechanism former = before;
  try {
    evaluate_formulas(former);
    return false;
  } catch (const SceneError&) {
    return evaluate_what_can_be(next) <= evaluate_what_can_be(former);
  }
}

// What is thrown leaves the mechanism as it was.
template <class Change>
void all_or_nothing(Mechanism& mechanism, const Change& change) {
  Mechanism next = mechanism;
  change(next);
  try {
    evaluate_formulas(next);
  } catch (const SceneError&) {
    if (!take_with_mistakes(mechanism, next)) throw;
  }
  mechanism = std::move(next);
}

// A body's turn about an axis.
struct TurnPlace {
  Body* body = nullptr; // null: the address is none of a turn
  std::size_t axis = 0;
  Turns turns; // as they are
};

TurnPlace turn_place(Mechanism& mechanism, const std::string& address) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string start = "bodies.", end = ".turn." + std::to_string(axis);
    if (!address.starts_with(start) || !address.ends_with(end)) continue;
    const int index =
        body_index(mechanism, address.substr(start.size(), address.size() - start.size() - end.size()));
    if (index < 0) continue;
    Body& body = mechanism.bodies[static_cast<std::size_t>(index)];
    return {&body, axis, given_turns(mechanism, body).value_or(Turns{turns_of(body.rotation), {}})};
  }
  return {};
}

void put_turn(Mechanism& mechanism, TurnPlace place, const std::string& address, const std::string& text) {
  if (!text.empty()) { // in its own words before it is part of a longer one
    const double angle = evaluate_expression(mechanism, text, "rad", address);
    place.turns.angles[static_cast<Eigen::Index>(place.axis)] = angle * 180 / std::numbers::pi;
  }
  place.turns.texts[place.axis] = text;
  set_turns(*place.body, place.turns);
}

void put(Mechanism& mechanism, const std::string& address, const std::string& text) {
  if (TurnPlace turn = turn_place(mechanism, address); turn.body)
    return put_turn(mechanism, std::move(turn), address, text);
  const auto [formulas, key] = formula_place(mechanism, address);
  if (!formulas) throw SceneError(address, "there is no such number");
  std::erase_if(*formulas, [&key = key](const Formula& formula) { return formula.key == key; });
  if (!text.empty()) formulas->push_back({std::string(key), text});
  std::ranges::sort(*formulas, {}, &Formula::key); // as a file is read
}

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

bool names(std::string_view text, std::string_view name) {
  try {
    const Expression expression(text, Expression::Results::allowed);
    for (const ResultCall& call : expression.results())
      if (std::ranges::find(call.arguments, name, &ResultCall::Argument::point) != call.arguments.end())
        return true;
    return std::ranges::any_of(expression.names(), [&](const std::string& each) {
      return std::string_view(each).substr(0, each.find('.')) == name;
    });
  } catch (const ExpressionError&) {
    return false;
  }
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
          return formula.key.starts_with("rotation.") && names(formula.text, name);
        }))
      forget_rotation(body.formulas);
  visit_formulas(mechanism, [&](Formulas& formulas) {
    std::erase_if(formulas, [&](const Formula& formula) { return names(formula.text, name); });
  });
  std::erase_if(mechanism.sliders, [&](const Slider& slider) {
    return slider.parameter == path || slider.parameter.starts_with(path + ".");
  });
}

bool near(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * (1 + std::abs(b));
}
constexpr double rounding = 1e-12;
// What is left of a residual by Newton's method is far below a hand's accuracy.
constexpr double solved = 1e-9;

double evaluated(const Mechanism& mechanism, const GivenNumber& given) {
  return evaluate_expression(mechanism, given.text, given.unit, given.address);
}

// Dependent parameters and points first.
void evaluate_names(Mechanism& mechanism) {
  Mechanism named;
  named.parameters = std::move(mechanism.parameters);
  named.points = std::move(mechanism.points);
  evaluate_formulas(named);
  mechanism.parameters = std::move(named.parameters);
  mechanism.points = std::move(named.points);
}

std::string unit_at(const Mechanism& mechanism, const std::string& address) {
  Mechanism& looked_at = const_cast<Mechanism&>(mechanism); // no more
  return turn_place(looked_at, address).body ? "rad" : expressible_number(looked_at, address).unit;
}

[[noreturn]] void refuse(const Mechanism& mechanism, const GivenNumber& given) {
  std::string sources;
  for (const std::string& source : sources_of(mechanism, given.text))
    sources += (sources.empty() ? "; it rests on " : ", ") + source;
  throw SceneError(given.address, "given by \"=" + given.text + "\", which this would not be" + sources);
}

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

// The numbers that the moved ones rest on, found by Newton's method so that these have their values and the
// others of their parts keep theirs.
void solve_for_sources(Mechanism& next, std::vector<GivenNumber> wanted,
                       const std::vector<GivenNumber>& others) {
  const GivenNumber first = wanted.front();
  std::vector<std::string> sources;
  for (const GivenNumber& given : wanted)
    for (const std::string& source : sources_of(next, given.text))
      if (!contains(sources, source)) sources.push_back(source);
  if (sources.empty()) refuse(next, first);
  for (const GivenNumber& given : others) {
    const std::vector<std::string> its = sources_of(next, given.text);
    if (std::ranges::any_of(its, [&](const std::string& source) { return contains(sources, source); }))
      wanted.push_back(given);
  }
  const auto rows = static_cast<Eigen::Index>(wanted.size()),
             columns = static_cast<Eigen::Index>(sources.size());
  Eigen::MatrixXd jacobian(rows, columns);
  Eigen::VectorXd rest(rows);
  Mechanism named;
  named.parameters = next.parameters;
  named.points = next.points;
  for (int iteration = 0; iteration < 30; ++iteration) {
    bool done = true;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const GivenNumber& given = wanted[static_cast<std::size_t>(i)];
      const double value = evaluated(named, given);
      rest[i] = given.value - value;
      done = done && near(value, given.value, rounding);
      const std::vector<double> gradient = expression_gradient(named, given.text, sources);
      jacobian.row(i) = Eigen::Map<const Eigen::RowVectorXd>(gradient.data(), columns);
    }
    if (!jacobian.allFinite()) refuse(next, first);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
    if (qr.rank() < columns) refuse(next, first); // several ways to do it
    const Eigen::VectorXd step = qr.solve(rest);
    if (done || step.norm() == 0) break;
    for (Eigen::Index k = 0; k < columns; ++k) {
      const std::string& source = sources[static_cast<std::size_t>(k)];
      set_parameter(named, source, get_parameter(named, source) + step[k]);
    }
  }
  for (const GivenNumber& given : wanted)
    if (!near(evaluated(named, given), given.value, solved)) refuse(next, first);
  next.parameters = std::move(named.parameters);
  next.points = std::move(named.points);
}

// Of a parameter or point.
bool is_named(const GivenNumber& given) {
  return given.part.starts_with("parameters.") || given.part.starts_with("points.");
}

template <class Parts>
void add_names(const std::string& list, const Parts& parts, std::unordered_set<std::string>& to) {
  for (const auto& part : parts)
    to.insert(list + "." + part.name);
}

// "bodies.arm" of "bodies.arm.shapes.0".
std::string owner(const std::string& part) {
  const std::size_t dot = part.find('.');
  return dot == std::string::npos ? part : part.substr(0, part.find('.', dot + 1));
}

} // namespace

std::optional<std::string> expression_at(const Mechanism& mechanism, const std::string& address) {
  const TurnPlace turn = turn_place(const_cast<Mechanism&>(mechanism), address); // only looked at
  if (!turn.body) return formula_at(mechanism, address);
  const std::string& text = turn.turns.texts[turn.axis];
  return text.empty() ? std::nullopt : std::optional(text);
}

double expressed_value(const Mechanism& mechanism, const std::string& address) {
  Mechanism& looked_at = const_cast<Mechanism&>(mechanism); // no more
  if (const TurnPlace turn = turn_place(looked_at, address); turn.body)
    return turn.turns.angles[static_cast<Eigen::Index>(turn.axis)] * std::numbers::pi / 180;
  return expressible_number(looked_at, address).value;
}

void set_by_itself(Mechanism& mechanism, const std::string& address, double value) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    if (TurnPlace turn = turn_place(next, address); turn.body) {
      turn.turns.texts[turn.axis].clear();
      turn.turns.angles[static_cast<Eigen::Index>(turn.axis)] = value * 180 / std::numbers::pi;
      return set_turns(*turn.body, turn.turns);
    }
    put(next, address, "");
    expressible_number(next, address).set(value);
  });
}

namespace {

// An expression of the deflection or rate is the whole force: it stands in the place of the stiffness or
// damping that it was given for. False where it is none.
bool put_law(Mechanism& mechanism, const std::string& address, const std::string& text) {
  const auto [formulas, key] = formula_place(mechanism, address);
  if (!formulas) return false;
  const bool spring = key.ends_with("stiffness") && !key.starts_with("stop") && names(text, spring_variable);
  if (!spring && !(key.starts_with("damping") && names(text, damper_variable))) return false;
  const auto set = [&, &all = *formulas, &old = key](double& number, std::optional<double>& force,
                                                     const std::string& law, bool angle) {
    const auto check = spring ? check_spring_law : check_damper_law;
    check(mechanism, {law, text}, angle, address);
    number = 0;
    force = 0;
    std::erase_if(all, [&](const Formula& each) { return each.key == old || each.key == law; });
    all.push_back({law, text});
    std::ranges::sort(all, {}, &Formula::key);
    std::erase_if(mechanism.sliders, [&](const Slider& each) { return each.parameter == address; });
    return true;
  };
  for (Force& each : mechanism.forces)
    if (&each.formulas == formulas && each.type == ForceType::spring)
      return spring ? set(each.stiffness, each.force, "force", false)
                    : set(each.damping, each.damping_force, "damping_force", false);
  for (Joint& joint : mechanism.joints)
    for (std::size_t i = 0; &joint.formulas == formulas && i < joint.coordinates.size(); ++i) {
      Coordinate& c = joint.coordinates[i];
      const std::string of_spring = coordinate_key(joint, i, "spring");
      const bool angle = is_angle(joint.type, static_cast<int>(i));
      if (spring && c.spring && key == of_spring + ".stiffness")
        return set(c.spring->stiffness, c.spring->force, of_spring + ".force", angle);
      if (!spring && key == coordinate_key(joint, i, "damping"))
        return set(c.damping, c.damping_force, coordinate_key(joint, i, "damping_force"), angle);
    }
  return false;
}

// A torque or load that is a law of the state has no value that would tell that it means something.
void check_drive_laws(const Mechanism& mechanism, const std::string& address) {
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; !joint.formulas.empty() && i < joint.coordinates.size(); ++i)
      for (const char* which : {"torque", "load"}) {
        const int coordinate = static_cast<int>(i);
        if ("joints." + joint.name + "." + coordinate_key(joint, i, "drive") + "." + which != address)
          continue;
        if (const Formula* law = drive_law(mechanism, joint, coordinate, which))
          check_drive_law(mechanism, *law, is_angle(joint.type, coordinate), address);
      }
}

} // namespace

void set_expression(Mechanism& mechanism, const std::string& address, const std::string& text) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    if (!put_law(next, address, text)) put(next, address, text);
    check_drive_laws(next, address);
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
  units.insert(units.begin(), unit_at(mechanism, address));
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

void stand_at_point(Mechanism& mechanism, const std::string& vector, const std::string& point) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    for (const int i : {0, 1, 2})
      put(next, vector + "." + std::to_string(i), point_coordinate(point, i));
  });
}

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
      put(next, vector + "." + std::to_string(i), point_coordinate(name, i));
  });
}

void name_number(Mechanism& mechanism, const std::string& address, const std::string& name) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    check_name(next, name, "parameters." + name);
    NamedParameter parameter;
    parameter.name = name;
    parameter.value = expressed_value(next, address);
    parameter.unit = unit_at(next, address);
    if (const std::optional<std::string> formula = expression_at(next, address))
      parameter.formulas = {{"value", *formula}};
    next.parameters.push_back(std::move(parameter));
    put(next, address, name);
    // A slider of the number is one of the parameter.
    for (Slider& slider : next.sliders)
      if (slider.parameter == address) slider.parameter = "parameters." + name;
  });
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

namespace {

// Calls with every law (drive_law.hpp, force_law.hpp) that names it, and the address of its number.
template <class Visit>
void visit_laws(Mechanism& mechanism, const std::string& name, const Visit& visit) {
  std::vector<std::pair<std::string, Formula*>> laws;
  const auto collect = [&](const std::string& list, auto& parts) {
    for (auto& part : parts)
      for (Formula& formula : part.formulas)
        if ((is_drive_law(mechanism, formula) || is_force_law(formula)) && names(formula.text, name))
          laws.emplace_back(list + part.name + "." + formula.key, &formula);
  };
  collect("joints.", mechanism.joints);
  collect("forces.", mechanism.forces);
  for (const auto& [address, formula] : laws)
    visit(address, *formula);
}

} // namespace

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
    if (names(given.text, name)) users.push_back(given.address);
  for (const NamedMeasure& measure : mechanism.measures)
    if (names(measure.text, name)) users.push_back("measures." + measure.name);
  return users;
}

namespace {

// `next` with the sources of what the edit has moved.
Mechanism settle(const Mechanism& before, const Mechanism& next) {
  Mechanism settled = next;
  drop_lost_formulas(settled);
  evaluate_names(settled);
  std::unordered_set<std::string> former;
  add_names("bodies", before.bodies, former);
  add_names("joints", before.joints, former);
  add_names("forces", before.forces, former);
  std::unordered_map<std::string, GivenNumber> given_before;
  for (GivenNumber& given : given_numbers(before))
    given_before.emplace(given.address, given);

  std::unordered_set<std::string> moved_parts, moved_numbers;
  std::vector<GivenNumber> moved, others;
  // Whether the edit has set it, and not what its expression says.
  const auto is_moved = [&](const GivenNumber& given) {
    const auto earlier = given_before.find(given.address);
    return earlier != given_before.end() && earlier->second.text == given.text &&
           earlier->second.value != given.value && !near(evaluated(settled, given), given.value, rounding);
  };
  for (const GivenNumber& given : given_numbers(next))
    if (is_named(given) && is_moved(given)) moved.push_back(given);
  const std::vector<GivenNumber> all = given_numbers(settled);
  for (const GivenNumber& given : all) {
    if (is_named(given) || is_of_state(next, given.text)) continue;
    const std::string part = owner(given.part);
    const bool is_part =
        part.find('.') != std::string::npos && !part.starts_with("gravity") && !part.starts_with("air.");
    if (is_part && !former.contains(part)) {
      bool same = false;
      try {
        same = near(evaluated(settled, given), given.value, solved);
      } catch (const SceneError&) { // of names that are not here
      }
      if (same) continue;
      put(settled, given.address, "");
      // One number of a rotation alone says nothing.
      if (given.address.starts_with(given.part + ".rotation."))
        for (const int i : {0, 1, 2, 3})
          put(settled, given.part + ".rotation." + std::to_string(i), "");
      continue;
    }
    if (!is_moved(given)) continue;
    moved_parts.insert(given.part);
    moved_numbers.insert(given.address);
    moved.push_back(given);
  }
  if (!moved.empty()) {
    for (const GivenNumber& given : all)
      if (moved_parts.contains(given.part) && !moved_numbers.contains(given.address)) others.push_back(given);
    solve_for_sources(settled, std::move(moved), others);
  }
  evaluate_formulas(settled);
  return settled;
}

} // namespace

void settle_formulas(const Mechanism& before, Mechanism& next) {
  if (used_of_version_2(next).empty()) return;
  try {
    next = settle(before, next);
  } catch (const SceneError&) {
    drop_lost_formulas(next);
    if (!take_with_mistakes(before, next)) throw;
  }
}

} // namespace flyball
