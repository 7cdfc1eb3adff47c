#include "engine/mechanism/measure_plan.hpp"

#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/given_names.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/part_hint.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/unit_hint.hpp"

#include <algorithm>
#include <unordered_map>

namespace flyball {
namespace {

constexpr std::size_t most_measures = 1000;

std::size_t place(int i) {
  return static_cast<std::size_t>(i);
}

template <class Part>
[[noreturn]] void fail_part(std::string_view kind, const std::string& name, const std::vector<Part>& parts) {
  std::vector<std::string_view> names;
  for (const Part& part : parts)
    names.push_back(part.name);
  throw ExpressionError("no " + std::string(kind) + " is called \"" + name + "\"" +
                        did_you_mean(name, names) + (names.empty() ? "" : "; expected " + word_list(names)));
}

// What a measure asks of, by name to place.
class Finder {
 public:
  explicit Finder(const Mechanism& mechanism) : m_(mechanism) {}

  ResultQuantity find(const ResultCall& call) const {
    ResultQuantity out{.result = call.result, .count = static_cast<int>(call.arguments.size())};
    const ArgumentKind kind = argument_kind(result_function(call.result), call.arguments.size());
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      const ResultCall::Argument& argument = call.arguments[i];
      try {
        out.of[i] = find(kind, argument);
        if (kind == ArgumentKind::coordinate) {
          const Joint& joint = m_.joints[place(out.of[i].part)];
          out.angle = is_angle(joint.type, out.of[i].coordinate);
        }
        expect_it(call.result, kind, out.of[i], argument.name);
      } catch (const ExpressionError& error) {
        throw ExpressionError("column " + std::to_string(argument.begin + 1) + ": " + error.what());
      }
    }
    return out;
  }

 private:
  ResultQuantity::Of find(ArgumentKind kind, const ResultCall::Argument& a) const {
    switch (kind) {
    case ArgumentKind::coordinate: {
      const int j = joint_index(m_, a.name);
      if (j < 0 && a.name.ends_with(implicit_joint)) throw ExpressionError(std::string(implicit_joint_hint));
      if (j < 0) fail_part("joint", a.name, m_.joints);
      const int count = coordinate_count(m_.joints[place(j)].type);
      const std::string joint =
          std::string(type_name(m_.joints[place(j)].type)) + " joint \"" + a.name + "\"";
      if (count == 0) throw ExpressionError("the " + joint + " has no coordinate");
      if (a.index >= count || (a.index < 0 && count > 1))
        throw ExpressionError(
            "expected a coordinate of the " + joint +
            (count == 1 ? ", which has one alone" : ": .0 to ." + std::to_string(count - 1)));
      return {j, std::max(a.index, 0), -1};
    }
    case ArgumentKind::joint: {
      const int j = joint_index(m_, a.name);
      if (j < 0 && is_bearing(force_index(m_, a.name)))
        throw ExpressionError("expected a joint; \"" + a.name +
                              "\" is a bearing, of which force() and couple() tell");
      if (j < 0) fail_part("joint", a.name, m_.joints);
      return {j, 0, -1};
    }
    case ArgumentKind::force: {
      const int f = force_index(m_, a.name);
      if (f < 0) fail_part("force", a.name, m_.forces);
      return {f, 0, -1};
    }
    case ArgumentKind::body:
    case ArgumentKind::point: break;
    }
    ResultQuantity::Of of{body_index(m_, a.name), 0, -1};
    if (a.name == ground_name && kind == ArgumentKind::point && a.point.empty())
      throw ExpressionError("expected a named point of the ground, as in ground@A");
    if (of.part < 0 && (a.name != ground_name || kind == ArgumentKind::body))
      fail_part("body", a.name, m_.bodies);
    if (a.point.empty()) return of;
    of.point = point_index(m_, a.point);
    if (of.point < 0) fail_part("point", a.point, m_.points);
    return of;
  }

  bool is_bearing(int force) const {
    return force >= 0 && m_.forces[place(force)].type == ForceType::bearing;
  }

  // That a spring or a bearing is what is asked of.
  void expect_elastic(Result result, int force, const std::string& quoted) const {
    const ForceType type = m_.forces[place(force)].type;
    const bool of_springs = result == Result::length || result == Result::tension;
    const bool of_bearings = result >= Result::couple_x && result <= Result::couple;
    if ((type == ForceType::spring && !of_bearings) || (type == ForceType::bearing && !of_springs)) return;
    throw ExpressionError(std::string("expected a ") +
                          (of_springs    ? "spring"
                           : of_bearings ? "bearing"
                                         : "spring or a bearing") +
                          "; " + quoted + " is a " + std::string(type_name(type)));
  }

  // That the part has what is asked for.
  void expect_it(Result result, ArgumentKind kind, const ResultQuantity::Of& of,
                 const std::string& name) const {
    const std::string quoted = "\"" + name + "\"";
    if (kind == ArgumentKind::coordinate) {
      const Coordinate& c = m_.joints[place(of.part)].coordinates.at(place(of.coordinate));
      if (result == Result::spring && !c.spring) throw ExpressionError(quoted + " has no spring");
      if (result == Result::clearance && !c.stop) throw ExpressionError(quoted + " has no stop");
      if ((result == Result::torque || result == Result::power) && !c.drive)
        throw ExpressionError(quoted + " has no drive");
    } else if (kind == ArgumentKind::joint && m_.joints[place(of.part)].type == JointType::gear) {
      throw ExpressionError("expected a joint between two bodies; " + quoted +
                            " is a gear, which the reactions of its two joints include");
    } else if (kind == ArgumentKind::force) {
      expect_elastic(result, of.part, quoted);
    } else if (result == Result::clearance) {
      if (m_.bodies[place(of.part)].shapes.empty())
        throw ExpressionError(quoted + " has no shapes of its own");
    }
  }

  const Mechanism& m_;
};

Dimension dimension_of(const ResultQuantity& quantity) {
  return parse_unit(result_unit(quantity)).value_or(Unit{}).dimension.without_angle();
}

} // namespace

std::string_view result_unit(const ResultQuantity& quantity) {
  switch (quantity.result) {
  case Result::clearance:
  case Result::coordinate: return quantity.angle ? "rad" : "m";
  case Result::rate: return quantity.angle ? "rad/s" : "m/s";
  case Result::x:
  case Result::y:
  case Result::z:
  case Result::distance:
  case Result::length: return "m";
  case Result::vx:
  case Result::vy:
  case Result::vz:
  case Result::speed: return "m/s";
  case Result::ax:
  case Result::ay:
  case Result::az:
  case Result::acceleration: return "m/s^2";
  case Result::angle: return "rad";
  case Result::tension:
  case Result::force_x:
  case Result::force_y:
  case Result::force_z:
  case Result::force:
  case Result::reaction_x:
  case Result::reaction_y:
  case Result::reaction_z:
  case Result::reaction: return "N";
  case Result::couple_x:
  case Result::couple_y:
  case Result::couple_z:
  case Result::couple:
  case Result::moment_x:
  case Result::moment_y:
  case Result::moment_z:
  case Result::moment: return "N m";
  case Result::spring:
  case Result::torque: return quantity.angle ? "N m" : "N";
  case Result::power: return "W";
  case Result::mass: break;
  }
  return "kg";
}

class MeasureCompiler {
 public:
  MeasureCompiler(const Mechanism& mechanism, Mistakes& mistakes)
      : m_(mechanism), mistakes_(mistakes), finder_(mechanism) {}

  MeasurePlan run() {
    MeasurePlan plan;
    if (m_.measures.size() > most_measures) {
      mistakes_.add("measures", "expected at most " + std::to_string(most_measures) + " measures, found " +
                                    std::to_string(m_.measures.size()));
      return plan;
    }
    plan.texts_ = m_.measures;
    for (const NamedParameter& parameter : m_.parameters) {
      plan.parameters_.push_back(parameter.name);
      places_.emplace(parameter.name, places_.size());
      units_.push_back(unit_of(parameter.unit));
    }
    for (const NamedPoint& point : m_.points) {
      plan.points_.push_back(point.name);
      for (const int i : {0, 1, 2})
        places_.emplace(point_coordinate(point.name, i), places_.size());
    }
    first_ = m_.parameters.size() + 3 * m_.points.size();
    units_.resize(first_, {{.length = 1}, false});
    for (const NamedMeasure& measure : m_.measures) {
      places_.emplace(measure.name, places_.size());
      units_.push_back(unit_of(measure.unit));
    }
    const std::size_t before = mistakes_.all().size();
    for (const NamedMeasure& measure : m_.measures)
      compile(measure, plan);
    if (mistakes_.all().size() == before) put_in_order(plan);
    plan.values_.resize(first_ + m_.measures.size());
    return plan;
  }

 private:
  static ValueDimension unit_of(const std::string& unit) {
    return {parse_unit(unit).value_or(Unit{}).dimension.without_angle(), false};
  }
  static std::string place_of(const NamedMeasure& measure) { return "measures." + measure.name; }

  void compile(const NamedMeasure& measure, MeasurePlan& plan) {
    // What is wanted or plotted is called by its name alone.
    if (joint_index(m_, measure.name) >= 0)
      mistakes_.add(place_of(measure), "expected another name: a joint's coordinate is called so");
    const std::optional<Unit> unit = parse_unit(measure.unit);
    if (!unit || unit->factor != 1)
      mistakes_.add(place_of(measure) + ".unit",
                    "expected an SI unit, such as m, N/m or rad, found \"" + measure.unit + "\"");
    try {
      plan.measures_.push_back({Expression(measure.text, Expression::Results::allowed), {}, {}});
      MeasurePlan::Compiled& compiled = plan.measures_.back();
      std::vector<ValueDimension> names, results;
      for (const std::string& name : compiled.expression.names()) {
        compiled.names.push_back(place_of_name(name));
        names.push_back(units_[compiled.names.back()]);
      }
      for (const ResultCall& call : compiled.expression.results()) {
        const ResultQuantity quantity = finder_.find(call);
        results.push_back({dimension_of(quantity), false});
        const auto found = std::ranges::find(plan.quantities_, quantity);
        compiled.results.push_back(static_cast<std::size_t>(found - plan.quantities_.begin()));
        if (found == plan.quantities_.end()) plan.quantities_.push_back(quantity);
      }
      const ValueDimension found = compiled.expression.dimension(names, results);
      if (unit) expect_dimension(found, measure.unit);
    } catch (const ExpressionError& error) {
      mistakes_.add(place_of(measure), "\"=" + shortened(measure.text) + "\": " + error.what());
    }
  }

  static std::string shortened(const std::string& text) {
    constexpr std::size_t longest = 60;
    return text.size() > longest ? text.substr(0, longest) + "..." : text;
  }

  std::size_t place_of_name(const std::string& name) const {
    if (const auto found = places_.find(name); found != places_.end()) return found->second;
    if (point_index(m_, name) >= 0)
      throw ExpressionError("expected a coordinate of the point: " + name + ".x, " + name + ".y or " + name +
                            ".z");
    std::vector<std::string_view> known;
    for (const auto& [each, place] : places_)
      known.push_back(each);
    std::ranges::sort(known);
    const std::string part = part_hint(m_, name);
    throw ExpressionError("there is no parameter or measure \"" + name + "\"" +
                          (part.empty() ? unit_hint(name) + did_you_mean(name, known) : part));
  }

  void put_in_order(MeasurePlan& plan) {
    enum class Mark { open, entered, done };
    std::vector<Mark> marks(plan.measures_.size(), Mark::open);
    std::vector<std::size_t> path;
    const auto visit = [&](const auto& self, std::size_t i) -> bool {
      if (marks[i] == Mark::done) return true;
      path.push_back(i);
      if (marks[i] == Mark::entered) return false;
      marks[i] = Mark::entered;
      for (const std::size_t name : plan.measures_[i].names)
        if (name >= first_ && !self(self, name - first_)) return false;
      marks[i] = Mark::done;
      path.pop_back();
      plan.order_.push_back(i);
      return true;
    };
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (visit(visit, i)) continue;
      std::string circle;
      for (auto it = std::ranges::find(path, path.back()); it + 1 != path.end(); ++it)
        circle += m_.measures[*it].name + ", ";
      return mistakes_.add(place_of(m_.measures[path.back()]),
                           "expected no circle of measures; this one goes through " + circle + "and back");
    }
  }

  const Mechanism& m_;
  Mistakes& mistakes_;
  Finder finder_;
  std::unordered_map<std::string, std::size_t> places_;
  std::vector<ValueDimension> units_; // by place
  std::size_t first_ = 0;             // measure
};

MeasurePlan::MeasurePlan(const Mechanism& mechanism) {
  if (mechanism.measures.empty()) return;
  Mistakes mistakes;
  *this = MeasureCompiler(mechanism, mistakes).run();
  if (!mistakes.all().empty()) throw mistakes.all().front();
  set_numbers(mechanism);
}

bool MeasurePlan::fits(const Mechanism& mechanism) const {
  return mechanism.measures == texts_ &&
         (texts_.empty() ||
          (std::ranges::equal(mechanism.parameters, parameters_, {}, &NamedParameter::name) &&
           std::ranges::equal(mechanism.points, points_, {}, &NamedPoint::name)));
}

void MeasurePlan::set_numbers(const Mechanism& mechanism) {
  if (empty()) return;
  GivenNames::take_values(mechanism, values_);
}

void MeasurePlan::set_numbers(const Mechanism& mechanism, const NumberRates& rates) {
  if (empty()) return;
  GivenNames::take_values(mechanism, rates, values_);
}

void MeasurePlan::evaluate(std::span<const Dual> quantities, std::span<Dual> measures) {
  const std::size_t first = values_.size() - measures_.size();
  for (const std::size_t i : order_) {
    const Compiled& each = measures_[i];
    measures[i] = values_[first + i] =
        each.expression.evaluate(values_, each.names, quantities, each.results);
  }
}

std::vector<bool> MeasurePlan::users_of(std::size_t quantity) const {
  const std::size_t first = values_.size() - measures_.size();
  std::vector<bool> users(measures_.size());
  for (const std::size_t i : order_)
    users[i] = std::ranges::find(measures_[i].results, quantity) != measures_[i].results.end() ||
               std::ranges::any_of(measures_[i].names,
                                   [&](std::size_t name) { return name >= first && users[name - first]; });
  return users;
}

void find_measure_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  MeasureCompiler(mechanism, mistakes).run();
}

ResultQuantity find_quantity(const Mechanism& mechanism, const ResultCall& call) {
  return Finder(mechanism).find(call);
}

std::string quantity_text(const Mechanism& m, const ResultQuantity& quantity) {
  const ResultFunction& function = result_function(quantity.result);
  const ArgumentKind kind = argument_kind(function, place(quantity.count));
  const auto name = [&](const ResultQuantity::Of& of) {
    switch (kind) {
    case ArgumentKind::coordinate: return coordinate_name(m.joints[place(of.part)], of.coordinate);
    case ArgumentKind::joint: return m.joints[place(of.part)].name;
    case ArgumentKind::force: return m.forces[place(of.part)].name;
    case ArgumentKind::body:
    case ArgumentKind::point: break;
    }
    const std::string body = of.part < 0 ? std::string(ground_name) : m.bodies[place(of.part)].name;
    return of.point < 0 ? body : body + "@" + m.points[place(of.point)].name;
  };
  std::string out(function.name);
  for (int i = 0; i < quantity.count; ++i)
    out += (i == 0 ? "(" : ", ") + name(quantity.of[place(i)]);
  return out + (quantity.count == 0 ? "()" : ")");
}

std::string_view result_unit(const Mechanism& mechanism, std::string_view expression) {
  const Expression read(expression, Expression::Results::allowed);
  if (read.results().empty())
    throw ExpressionError("it asks for no result, as coordinate(slide) or x(ball) do");
  return result_unit(Finder(mechanism).find(read.results().front()));
}

int measure_index(const Mechanism& mechanism, std::string_view name) {
  const auto found = std::ranges::find(mechanism.measures, name, &NamedMeasure::name);
  return found == mechanism.measures.end() ? -1 : static_cast<int>(found - mechanism.measures.begin());
}

} // namespace flyball
