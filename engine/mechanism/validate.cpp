#include "engine/mechanism/validate.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/numbers.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

namespace flyball {
namespace {

std::string name_mistake(const std::string& name) {
  if (name.empty()) return "expected a name that is not empty";
  if (name == ground_name) return "expected another name; \"ground\" is the fixed world";
  if (name.find('.') != std::string::npos)
    return "expected a name without dots, which separate the parts of an address";
  if (!is_usable_name(name)) return "expected a name without control characters";
  if (find_invalid_utf8(name) != std::string::npos) return "expected UTF-8 text";
  return {};
}

template <class Part>
void find_name_mistakes(const std::vector<Part>& parts, const std::string& list, Mistakes& mistakes) {
  std::map<std::string_view, std::size_t> seen;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string place = list + "[" + std::to_string(i) + "]";
    if (const std::string mistake = name_mistake(parts[i].name); !mistake.empty()) {
      mistakes.add(place + ".name", mistake);
      continue;
    }
    const auto [first, is_new] = seen.emplace(parts[i].name, i);
    if (!is_new)
      mistakes.add(place + ".name", "expected a name of its own; " + list + "[" +
                                        std::to_string(first->second) + "] is called \"" + parts[i].name +
                                        "\" too");
  }
}

// An address as a path in the JSON text: "axis.0" is axis[0].
std::string json_key(std::string_view key) {
  std::string path;
  while (!key.empty()) {
    const std::string_view segment = key.substr(0, key.find('.'));
    if (std::isdigit(static_cast<unsigned char>(segment.front())) != 0)
      path += "[" + std::string(segment) + "]";
    else
      path += (path.empty() ? "" : ".") + std::string(segment);
    key.remove_prefix(std::min(key.size(), segment.size() + 1));
  }
  return path;
}

// Beyond this the forces, products of up to seven numbers, overflow; no mechanism comes near.
constexpr double largest_number = 1e30;

// Whether all numbers among the fields that are visited are numbers, and not too large.
class NumberCheck {
 public:
  bool right() const { return right_; }

  void describe(const std::string&) {}
  void type(const Field&, const auto&) {}
  void field(const Field&, const auto& value) { check(value); }
  template <class Value>
  void field(const Field&, const Value& value, const Standard<Value>&) {
    check(value);
  }
  template <class Value>
  void field(const Field&, const std::optional<Value>& value, const Value& stands_for) {
    check(value.value_or(stands_for));
  }
  void pair(const Field&, const auto& a, const auto& b) {
    check(a);
    check(b);
  }
  void coordinates(const Joint& joint) {
    for (const Coordinate& coordinate : joint.coordinates)
      visit_fields(*this, coordinate);
  }

 private:
  void check(double value) { right_ = right_ && std::abs(value) <= largest_number; }
  void check(const Vec3& value) {
    for (const double each : value)
      check(each);
  }
  template <std::size_t n>
  void check(const std::array<double, n>& values) {
    for (const double each : values)
      check(each);
  }
  void check(const BearingMatrix& entries) {
    for (const double each : entries)
      check(each);
  }
  void check(const std::array<Vec3, 2>& points) {
    check(points[0]);
    check(points[1]);
  }
  void check(const CoordinateSpring& spring) { visit_fields(*this, spring); }
  void check(const Stop& stop) { visit_fields(*this, stop); }
  void check(const Friction& friction) { visit_fields(*this, friction); }
  void check(const Drive& drive) { visit_fields(*this, drive); }
  template <class Value>
  void check(const std::optional<Value>& value) {
    if (value) check(*value);
  }
  void check(const auto&) {} // no numbers, or not checked here

  bool right_ = true;
};

template <class Part, class... Of>
bool has_right_numbers(const Part& part, const Of&... of) {
  NumberCheck check;
  visit_fields(check, part, of...);
  return check.right();
}

void expect_finite(const std::vector<Number>& numbers, const std::string& prefix, Mistakes& mistakes) {
  for (const Number& number : numbers) {
    const std::string where = prefix + json_key(number.key);
    if (!std::isfinite(number.value))
      mistakes.add(where, "expected a finite number");
    else
      mistakes.expect(std::abs(number.value) <= largest_number, where, "expected no more than 1e30 in size");
  }
}

void find_non_finite(Vec3 gravity, Mistakes& mistakes) {
  if (!gravity.allFinite() || gravity.cwiseAbs().maxCoeff() > largest_number)
    expect_finite(numbers_of_gravity(gravity), "", mistakes);
}

void find_non_finite(const Air& air, Mistakes& mistakes) {
  if (has_right_numbers(air)) return;
  Air copy = air;
  expect_finite(numbers_of(copy), "", mistakes);
}

void find_non_finite(const Body& body, const std::string& path, Mistakes& mistakes) {
  if (!has_right_numbers(body)) {
    Body copy = body;
    expect_finite(numbers_of(copy), path + ".", mistakes);
  }
  mistakes.expect(body.rotation.coeffs().allFinite(), path, ".rotation", "expected four finite numbers");
}

void find_non_finite(const Mechanism& mechanism, const NamedParameter& parameter, Mistakes& mistakes) {
  const std::string path = "parameters." + parameter.name;
  if (!has_right_numbers(parameter)) {
    NamedParameter copy = parameter;
    expect_finite(numbers_of(copy), path + ".", mistakes);
  }
  if (!is_expression_name(parameter.name) || point_index(mechanism, parameter.name) >= 0)
    mistakes.add(path, "expected a name of letters, figures and _ that no point and no function has");
  if (!parameter.range) return;
  const auto [from, to] = *parameter.range;
  mistakes.expect(std::isfinite(from) && std::isfinite(to) && from < to, path, ".range",
                  "expected two finite numbers, the smaller one first");
}

void find_measure_name_mistakes(const Mechanism& mechanism, const NamedMeasure& measure, Mistakes& mistakes) {
  if (!is_expression_name(measure.name) || parameter_index(mechanism, measure.name) >= 0 ||
      point_index(mechanism, measure.name) >= 0)
    mistakes.add("measures." + measure.name,
                 "expected a name of letters, figures and _ that no parameter, no point and no function has");
}

void find_non_finite(const NamedPoint& point, Mistakes& mistakes) {
  const std::string path = "points." + point.name;
  mistakes.expect(point.at.allFinite() && point.at.cwiseAbs().maxCoeff() <= largest_number, path,
                  "expected three finite numbers, no more than 1e30 in size");
  if (!is_expression_name(point.name))
    mistakes.add(path, "expected a name of letters, figures and _ that no function has");
}

template <class JointOrForce>
void find_non_finite(const Mechanism& mechanism, const JointOrForce& part, const std::string& path,
                     Mistakes& mistakes) {
  if (has_right_numbers(part, &mechanism)) return;
  JointOrForce copy = part;
  expect_finite(numbers_of(mechanism, copy), path + ".", mistakes);
}

void find_formula_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  if (used_of_version_2(mechanism).empty()) return;
  try {
    Mechanism copy = mechanism;
    evaluate_formulas(copy);
  } catch (const SceneError& error) {
    mistakes.add(error.where(), error.expected());
  }
}

void find_non_finite(const Mechanism& mechanism, Mistakes& mistakes) {
  for (const NamedParameter& parameter : mechanism.parameters)
    find_non_finite(mechanism, parameter, mistakes);
  for (const NamedPoint& point : mechanism.points)
    find_non_finite(point, mistakes);
  for (const NamedMeasure& measure : mechanism.measures)
    find_measure_name_mistakes(mechanism, measure, mistakes);
  find_non_finite(mechanism.gravity, mistakes);
  find_non_finite(mechanism.air, mistakes);
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
    find_non_finite(mechanism.bodies[i], part_path("bodies", i, mechanism.bodies[i].name), mistakes);
  for (std::size_t i = 0; i < mechanism.joints.size(); ++i)
    find_non_finite(mechanism, mechanism.joints[i], joint_path(mechanism, i), mistakes);
  for (std::size_t i = 0; i < mechanism.forces.size(); ++i)
    find_non_finite(mechanism, mechanism.forces[i], part_path("forces", i, mechanism.forces[i].name),
                    mistakes);
}

constexpr std::size_t most_sliders = 10'000; // the answer's sensitivity to each is computed

void find_slider_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  if (mechanism.sliders.size() > most_sliders)
    return mistakes.add("sliders", "expected at most " + std::to_string(most_sliders) + " sliders, found " +
                                       std::to_string(mechanism.sliders.size()));
  for (std::size_t i = 0; i < mechanism.sliders.size(); ++i) {
    const Slider& slider = mechanism.sliders[i];
    const std::string path = "sliders[" + std::to_string(i) + "]";
    try {
      get_parameter(mechanism, slider.parameter);
    } catch (const SceneError& error) {
      mistakes.add(path + ".parameter", error.what());
    }
    const std::string range = path + ".range";
    if (!std::isfinite(slider.from) || !std::isfinite(slider.to))
      mistakes.add(range, "expected two finite numbers");
    else if (slider.from == slider.to)
      mistakes.add(range, "expected two different numbers, found " + number_text(slider.from) + " twice");
    else if (slider.scale == SliderScale::log && std::min(slider.from, slider.to) <= 0)
      mistakes.add(range, "expected two numbers above zero, since the scale is log");
  }
}

void find_setting_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  const double duration = mechanism.simulation.duration;
  mistakes.expect(std::isfinite(duration) && duration > 0, "simulation.duration",
                  "expected a number above zero");
  if (!mechanism.view.camera) return;
  const Camera& camera = *mechanism.view.camera;
  mistakes.expect(camera.target.allFinite(), "view.camera.target", "expected three finite numbers");
  mistakes.expect(std::isfinite(camera.distance) && camera.distance > 0, "view.camera.distance",
                  "expected a number above zero");
  mistakes.expect(std::isfinite(camera.azimuth), "view.camera.azimuth", "expected a finite number");
  mistakes.expect(std::isfinite(camera.elevation), "view.camera.elevation", "expected a finite number");
}

// Whether the part with the number at `address` has no mistake by which a mechanism that had none has one
// now; false also where other parts have to be looked at.
bool is_right_at(const Mechanism& mechanism, std::string_view address) {
  const std::string_view list = address.substr(0, address.find('.'));
  const std::string_view rest = address.substr(std::min(list.size() + 1, address.size()));
  const std::string_view name = rest.substr(0, rest.find('.'));
  Mistakes mistakes;
  const auto part_at = [&](const auto& parts, int index, const auto& find) {
    if (index < 0) return false;
    const auto i = static_cast<std::size_t>(index);
    find(parts[i], part_path(list, i, parts[i].name));
    return true;
  };
  bool found = true;
  if (list == "parameters" || list == "points") return false; // any part may follow from it
  if (list == "gravity") {
    find_non_finite(mechanism.gravity, mistakes);
  } else if (list == "air") {
    find_non_finite(mechanism.air, mistakes);
    find_mistakes_of(mechanism.air, mistakes);
  } else if (list == "simulation") {
    find_setting_mistakes(mechanism, mistakes);
  } else if (list == "bodies") {
    found = part_at(mechanism.bodies, body_index(mechanism, name), [&](const Body& body, const auto& path) {
      find_non_finite(body, path, mistakes);
      find_mistakes_of(body, path, mistakes);
    });
  } else if (list == "forces") {
    found =
        part_at(mechanism.forces, force_index(mechanism, name), [&](const Force& force, const auto& path) {
          find_non_finite(mechanism, force, path, mistakes);
          find_mistakes_of(mechanism, force, path, mistakes);
        });
  } else {
    // Gears tie the drives and drawn values of joints to each other.
    const bool geared =
        std::ranges::find(mechanism.joints, JointType::gear, &Joint::type) != mechanism.joints.end();
    const int joint = geared ? -1 : joint_index(mechanism, name);
    found = part_at(mechanism.joints, joint, [&](const Joint& each, const auto& path) {
      find_non_finite(mechanism, each, path, mistakes);
      find_mistakes_of_joint(mechanism, static_cast<std::size_t>(joint), mistakes);
    });
  }
  return found && mistakes.all().empty();
}

} // namespace

std::string part_path(std::string_view list, std::size_t i, std::string_view name) {
  return std::string(list) + (is_usable_name(name) ? "." + std::string(name) : "[" + std::to_string(i) + "]");
}

std::string joint_path(const Mechanism& mechanism, std::size_t joint) {
  return part_path("joints", joint, mechanism.joints[joint].name);
}

std::string coordinate_path(const Mechanism& mechanism, std::size_t joint, std::string_view key,
                            std::size_t i) {
  const std::string path = joint_path(mechanism, joint) + "." + std::string(key);
  return coordinate_count(mechanism.joints[joint].type) > 1 ? path + "[" + std::to_string(i) + "]" : path;
}

void add_unknown_body(const Mechanism& mechanism, std::string_view name, bool ground_too,
                      const std::string& where, Mistakes& mistakes) {
  std::vector<std::string_view> names;
  if (ground_too) names.push_back(ground_name);
  for (const Body& body : mechanism.bodies)
    names.push_back(body.name);
  mistakes.add(where, "no body is called \"" + std::string(name) + "\"" + did_you_mean(name, names) +
                          "; expected " +
                          (names.empty() ? "a body, of which there is none" : word_list(names)));
}

void find_two_body_mistakes(const Mechanism& mechanism, const BodyNumbers& numbers,
                            const std::array<std::string, 2>& bodies, const std::string& path,
                            Mistakes& mistakes) {
  for (std::size_t end = 0; end < 2; ++end)
    if (!numbers.has(bodies[end]))
      add_unknown_body(mechanism, bodies[end], true, path + ".bodies[" + std::to_string(end) + "]", mistakes);
  if (bodies[0] == bodies[1])
    mistakes.add(path + ".bodies", "expected two different bodies, found \"" + bodies[0] + "\" twice");
}

std::vector<SceneError> find_mistakes(const Mechanism& mechanism) {
  Mistakes mistakes;
  find_name_mistakes(mechanism.parameters, "parameters", mistakes);
  find_name_mistakes(mechanism.points, "points", mistakes);
  find_name_mistakes(mechanism.measures, "measures", mistakes);
  find_name_mistakes(mechanism.bodies, "bodies", mistakes);
  find_name_mistakes(mechanism.joints, "joints", mistakes);
  find_name_mistakes(mechanism.forces, "forces", mistakes);
  find_non_finite(mechanism, mistakes);
  find_formula_mistakes(mechanism, mistakes);
  // What follows compares numbers and looks up names, and would only repeat these in other words.
  if (!mistakes.all().empty()) return mistakes.all();
  find_body_mistakes(mechanism, mistakes);
  find_joint_mistakes(mechanism, mistakes);
  find_force_mistakes(mechanism, mistakes);
  find_air_mistakes(mechanism, mistakes);
  find_measure_mistakes(mechanism, mistakes);
  find_slider_mistakes(mechanism, mistakes);
  find_setting_mistakes(mechanism, mistakes);
  if (!mistakes.all().empty()) return mistakes.all();
  find_connection_mistakes(mechanism, mistakes);
  find_drive_mistakes(mechanism, mistakes);
  return mistakes.all();
}

std::vector<SceneError> find_mistakes(const Mechanism& mechanism, std::string_view address) {
  return is_right_at(mechanism, address) ? std::vector<SceneError>() : find_mistakes(mechanism);
}

void validate_numbers(const Mechanism& mechanism) {
  Mistakes mistakes;
  for (const NamedParameter& parameter : mechanism.parameters)
    mistakes.expect(has_right_numbers(parameter), parameter.name, "");
  for (const NamedPoint& point : mechanism.points)
    find_non_finite(point, mistakes);
  find_non_finite(mechanism.gravity, mistakes);
  find_non_finite(mechanism.air, mistakes);
  find_mistakes_of(mechanism.air, mistakes);
  bool geared = false;
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    find_non_finite(mechanism.bodies[i], mechanism.bodies[i].name, mistakes);
    find_mistakes_of(mechanism.bodies[i], mechanism.bodies[i].name, mistakes);
  }
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    find_non_finite(mechanism, mechanism.joints[j], mechanism.joints[j].name, mistakes);
    find_mistakes_of_joint(mechanism, j, mistakes);
    geared = geared || mechanism.joints[j].type == JointType::gear;
  }
  for (const Force& force : mechanism.forces) {
    find_non_finite(mechanism, force, force.name, mistakes);
    find_mistakes_of(mechanism, force, force.name, mistakes);
  }
  find_setting_mistakes(mechanism, mistakes);
  // Ratios above zero and drives that agree.
  if (geared || !mistakes.all().empty()) validate(mechanism);
}

std::vector<SceneError> find_warnings(const Mechanism& mechanism) {
  Mistakes warnings;
  find_body_warnings(mechanism, warnings);
  find_belt_warnings(mechanism, warnings);
  return warnings.all();
}

void validate(const Mechanism& mechanism) {
  const std::vector<SceneError> mistakes = find_mistakes(mechanism);
  if (!mistakes.empty()) throw mistakes.front();
}

} // namespace flyball
