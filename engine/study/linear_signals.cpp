#include "engine/study/linear_signals.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/measure_plan.hpp"

#include <algorithm>
#include <array>

namespace flyball {
namespace {

std::size_t place(int i) {
  return static_cast<std::size_t>(i);
}

// The argument of "torque(slide)", read as a measure reads that of "coordinate(slide)".
ResultCall::Argument read_argument(std::string_view as, std::string_view function, std::string_view text) {
  const Expression read(std::string(as) + std::string(text.substr(function.size())),
                        Expression::Results::allowed);
  if (read.results().size() != 1 || !text.ends_with(')'))
    throw ExpressionError("expected " + std::string(function) + "(...) alone");
  return read.results().front().arguments.front();
}

void take_torque(const ResultCall::Argument& of, const Mechanism& m, LinearInput& input) {
  const std::string name = of.index < 0 ? of.name : of.name + "." + std::to_string(of.index);
  const CoordinateReference found = find_coordinate(m, name);
  if (found.joint < 0) throw ExpressionError("expected a coordinate of a joint, not \"" + name + "\"");
  input.joint = found.joint;
  input.coordinate = found.coordinate;
  input.unit = is_angle(m.joints[place(found.joint)].type, found.coordinate) ? "N m" : "N";
}

void take_force(const ResultCall::Argument& of, int axis, Mechanism& m, LinearInput& input) {
  if (body_index(m, of.name) < 0) throw ExpressionError("expected a body, not \"" + of.name + "\"");
  Force force;
  force.name = "input " + std::to_string(m.forces.size());
  force.type = ForceType::force;
  force.body = of.name;
  if (!of.point.empty()) {
    const int point = point_index(m, of.point);
    if (point < 0) throw ExpressionError("no point is called \"" + of.point + "\"");
    force.at = m.points[place(point)].at;
  }
  input.address = "forces." + force.name + ".vector." + std::to_string(axis);
  input.unit = "N";
  input.force = true;
  m.forces.push_back(std::move(force));
}

LinearInput read_input(const std::string& text, Mechanism& m) {
  LinearInput input;
  input.name = text;
  try {
    if (text.starts_with("torque(")) {
      take_torque(read_argument("coordinate", "torque", text), m, input);
      return input;
    }
    for (const int axis : {0, 1, 2}) {
      const std::string_view function = std::array{"force_x", "force_y", "force_z"}[place(axis)];
      if (!text.starts_with(std::string(function) + "(")) continue;
      take_force(read_argument("x", function, text), axis, m, input);
      return input;
    }
  } catch (const ExpressionError& error) {
    throw SceneError("input " + text, error.what());
  }
  input.address = text;
  input.value = get_parameter(m, text);
  input.unit = parameter_unit(m, text);
  return input;
}

NamedMeasure read_output(const std::string& text, const Mechanism& m, std::size_t number) {
  NamedMeasure measure;
  measure.name = "output " + std::to_string(number);
  if (const int named = measure_index(m, text); named >= 0) {
    measure.unit = m.measures[place(named)].unit;
    measure.text = text;
    return measure;
  }
  const CoordinateReference coordinate = find_coordinate(m, text);
  measure.text =
      coordinate.joint < 0 ? text : "coordinate(" + argument_text(m.joints[place(coordinate.joint)].name);
  if (coordinate.joint >= 0) {
    const Joint& joint = m.joints[place(coordinate.joint)];
    if (coordinate_count(joint.type) > 1) measure.text += "." + std::to_string(coordinate.coordinate);
    measure.text += ")";
  }
  try {
    measure.unit = result_unit(m, measure.text);
  } catch (const ExpressionError& error) {
    const bool implicit = text.find(implicit_joint) != std::string::npos;
    throw SceneError("output " + text, "expected a measure, a joint's coordinate, or a result such as "
                                       "rate(slide): " +
                                           std::string(implicit ? implicit_joint_hint : error.what()));
  }
  return measure;
}

std::string as_state(const Mechanism& m, const std::string& output) {
  const Expression read(output, Expression::Results::allowed);
  if (read.results().size() != 1) return {};
  const ResultCall& call = read.results().front();
  if (call.begin != 0 || (call.result != Result::coordinate && call.result != Result::rate)) return {};
  const ResultCall::Argument& of = call.arguments.front();
  if (output.find(')', of.begin + of.length) + 1 != output.size()) return {};
  const CoordinateReference at = find_coordinate(m, call);
  if (at.joint < 0) return {};
  return coordinate_name(m.joints[place(at.joint)], at.coordinate) +
         (call.result == Result::rate ? ".rate" : "");
}

template <class Signal>
void refuse_twice(const std::vector<Signal>& signals, const char* what, const std::string& name) {
  if (std::ranges::find(signals, name, &Signal::name) != signals.end())
    throw SceneError(std::string(what) + " " + name, "is there twice");
}

} // namespace

LinearSignals read_signals(const Mechanism& mechanism, std::span<const std::string> inputs,
                           std::span<const std::string> outputs) {
  LinearSignals out{mechanism, {}, {}, {}};
  out.mechanism.sliders.clear(); // nobody asks for rates along them
  for (const std::string& text : inputs) {
    refuse_twice(out.inputs, "input", text);
    out.inputs.push_back(read_input(text, out.mechanism));
  }
  for (const std::string& text : outputs) {
    refuse_twice(out.outputs, "output", text);
    NamedMeasure measure = read_output(text, mechanism, out.outputs.size());
    out.outputs.push_back({text, measure.unit});
    out.mechanism.measures.push_back(std::move(measure));
    try {
      const MeasurePlan known(out.mechanism);
    } catch (const SceneError& error) { // the measure is the program's own, and not to be named
      throw SceneError("output " + text, error.expected());
    }
    out.as_states.push_back(as_state(mechanism, out.mechanism.measures.back().text));
  }
  return out;
}

} // namespace flyball
