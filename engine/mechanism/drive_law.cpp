#include "engine/mechanism/drive_law.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/given_names.hpp"
#include "engine/mechanism/part_hint.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/unit.hpp"
#include "engine/mechanism/unit_hint.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Throws ExpressionError.
ValueDimension dimension_of(const Mechanism& mechanism, const ResultCall& call) {
  const std::string_view unit = result_unit(find_law_quantity(mechanism, call));
  return {parse_unit(unit).value_or(Unit{}).dimension.without_angle(), false};
}

// The measure that a law means by a name; null where a parameter is called so, or no measure.
const NamedMeasure* measure_called(const Mechanism& mechanism, std::string_view name) {
  const int i = parameter_index(mechanism, name) < 0 ? measure_index(mechanism, name) : -1;
  return i < 0 ? nullptr : &mechanism.measures[static_cast<std::size_t>(i)];
}

// Whether it follows from where parts are and how they move, without a kink but at zero.
bool is_of_places(const ResultCall& call) {
  using enum Result;
  const Result result = call.result;
  return result != acceleration && (result <= vz || (result >= speed && result <= spring));
}

std::string refusal(const ResultCall& call) {
  return std::string(result_function(call.result).name) +
         "(): a torque or load is one of coordinates, rates, places and velocities of points, distances, "
         "angles, lengths, what springs and bearings exert and parameters; reactions and accelerations "
         "follow from the balance that it is part of";
}

// What a measure asks for that a law may not.
void expect_of_places(const NamedMeasure& measure, const Expression& expression) {
  for (const ResultCall& call : expression.results())
    if (!is_of_places(call)) throw ExpressionError(measure.name + " asks for " + refusal(call));
}

class MeasureWriter {
 public:
  explicit MeasureWriter(const Mechanism& mechanism) : mechanism_(mechanism) {}

  std::string write(std::string_view text) {
    const Expression expression(text, Expression::Results::allowed);
    std::string out(text);
    const std::vector<Expression::Mention>& mentions = expression.mentions();
    for (auto at = mentions.rbegin(); at != mentions.rend(); ++at) {
      const std::string& name = expression.names()[at->name];
      const NamedMeasure* measure = measure_called(mechanism_, name);
      if (!measure) continue;
      out.replace(at->begin, name.size(), "(" + inside(*measure) + ")");
      if (out.size() > longest) throw ExpressionError("expected a simpler expression");
    }
    return out;
  }

 private:
  static constexpr std::size_t longest = 20'000; // of a law
  static constexpr std::size_t deepest = 50;     // measures, each named by the one before

  std::string inside(const NamedMeasure& measure) {
    if (std::ranges::find(path_, measure.name) != path_.end())
      throw ExpressionError("expected no circle of measures; " + measure.name + " leads back to itself");
    if (path_.size() > deepest) throw ExpressionError("expected a simpler expression");
    expect_of_places(measure, Expression(measure.text, Expression::Results::allowed));
    path_.push_back(measure.name);
    std::string text = write(measure.text);
    path_.pop_back();
    return text;
  }

  const Mechanism& mechanism_;
  std::vector<std::string> path_; // of measures, each named by the one before
};

} // namespace

bool is_of_state(const Mechanism& mechanism, std::string_view text) {
  try {
    const Expression expression(text, Expression::Results::allowed);
    return !expression.results().empty() ||
           std::ranges::any_of(expression.names(), [&](const std::string& name) {
             return measure_called(mechanism, name) != nullptr;
           });
  } catch (const ExpressionError&) { // to be told where it is read as what it means to be
    return text.find("rate(") != std::string_view::npos || text.find("coordinate(") != std::string_view::npos;
  }
}

namespace {

// A joint's name by itself: a mistake, which is told as one of a law.
bool names_joint(const Mechanism& mechanism, std::string_view text) {
  try {
    const Expression expression(text);
    return std::ranges::any_of(expression.names(), [&](const std::string& name) {
      return parameter_index(mechanism, name) < 0 && joint_index(mechanism, name) >= 0;
    });
  } catch (const ExpressionError&) {
    return false;
  }
}

} // namespace

bool is_drive_law(const Mechanism& mechanism, const Formula& formula) {
  return formula.key.starts_with("drive.") &&
         (formula.key.ends_with(".torque") || formula.key.ends_with(".load")) &&
         (is_of_state(mechanism, formula.text) || names_joint(mechanism, formula.text));
}

const Formula* drive_law(const Mechanism& mechanism, const Joint& joint, int i, std::string_view which) {
  if (joint.formulas.empty()) return nullptr;
  const std::string key = coordinate_key(joint, static_cast<std::size_t>(i), "drive") + ".";
  const auto law = std::ranges::find(joint.formulas, key + std::string(which), &Formula::key);
  return law != joint.formulas.end() && is_drive_law(mechanism, *law) ? &*law : nullptr;
}

std::string with_measures(const Mechanism& mechanism, std::string_view text) {
  return MeasureWriter(mechanism).write(text);
}

Expression read_drive_law(const Mechanism& mechanism, std::string_view text) {
  constexpr std::size_t most = 32;
  Expression expression(with_measures(mechanism, text), Expression::Results::allowed);
  if (expression.names().size() > most || expression.results().size() > most)
    throw ExpressionError("expected a simpler expression");
  return expression;
}

bool asks_for_coordinate(const ResultCall& call) {
  return call.result == Result::coordinate || call.result == Result::rate || call.result == Result::spring;
}

ResultQuantity find_law_quantity(const Mechanism& mechanism, const ResultCall& call) {
  if (!is_of_places(call))
    throw ExpressionError("column " + std::to_string(call.begin + 1) + ": found " + refusal(call));
  if (!asks_for_coordinate(call) || call.result == Result::spring) return find_quantity(mechanism, call);
  const CoordinateReference at = find_coordinate(mechanism, call);
  const bool angle = is_angle(mechanism.joints[static_cast<std::size_t>(at.joint)].type, at.coordinate);
  return {call.result, 1, {ResultQuantity::Of{at.joint, at.coordinate, -1}}, angle};
}

CoordinateReference find_coordinate(const Mechanism& mechanism, const ResultCall& call) {
  const ResultCall::Argument& of = call.arguments.front();
  const CoordinateReference at =
      find_coordinate(mechanism, of.index < 0 ? of.name : of.name + "." + std::to_string(of.index));
  if (at.joint >= 0) return at;
  std::vector<std::string> known;
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      known.push_back(coordinate_name(joint, static_cast<int>(i)));
  const std::vector<std::string_view> views(known.begin(), known.end());
  throw ExpressionError("column " + std::to_string(of.begin + 1) + ": there is no coordinate \"" + of.name +
                        "\"" + did_you_mean(of.name, views) +
                        (views.empty() ? "" : "; expected one of " + word_list(views)));
}

void check_drive_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where) {
  try {
    const Expression expression = read_drive_law(mechanism, law.text);
    std::vector<ValueDimension> names, results;
    const GivenNames known(mechanism);
    for (const std::string& name : expression.names()) {
      if (const std::string part = part_hint(mechanism, name); !known.has(name) && !part.empty())
        throw ExpressionError("there is no parameter \"" + name + "\"" + part);
      names.push_back(known.dimension(known.find(name)));
    }
    for (const ResultCall& call : expression.results())
      results.push_back(dimension_of(mechanism, call));
    expect_dimension(expression.dimension(names, results), fields::force_unit(angle));
  } catch (const ExpressionError& error) {
    throw SceneError(where, "\"=" + law.text + "\": " + error.what());
  }
}

const double& named_number(const Mechanism& mechanism, std::string_view name) {
  if (const int i = parameter_index(mechanism, name); i >= 0)
    return mechanism.parameters[static_cast<std::size_t>(i)].value;
  for (const NamedPoint& point : mechanism.points)
    for (const int i : {0, 1, 2})
      if (point_coordinate(point.name, i) == name) return point.at[i];
  throw ExpressionError("there is no parameter \"" + std::string(name) + "\"" + unit_hint(name));
}

} // namespace flyball
