#include "engine/study/standing_joints.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/turns_in_place.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace flyball {
namespace {

constexpr double farthest_place = 1e4; // rad or reaches from the state

bool asks_for_springs(const Mechanism& mechanism) {
  const auto asked = [](std::string_view text) {
    const Expression read(text, Expression::Results::allowed);
    return std::ranges::any_of(read.results(),
                               [](const ResultCall& call) { return call.result == Result::spring; });
  };
  return std::ranges::any_of(mechanism.measures,
                             [&](const NamedMeasure& measure) { return asked(measure.text); }) ||
         std::ranges::any_of(mechanism.joints, [&](const Joint& joint) {
           return std::ranges::any_of(joint.formulas, [&](const Formula& formula) {
             return formula.key.starts_with("drive") && !is_force_law(formula) && asked(formula.text);
           });
         });
}

std::string free_name(const Mechanism& mechanism, std::size_t i) {
  std::string name = "place_of_joint_" + std::to_string(i);
  while (parameter_index(mechanism, name) >= 0 || measure_index(mechanism, name) >= 0)
    name += "_";
  return name;
}

void remove_formulas(Joint& joint, const std::string& key) {
  std::erase_if(joint.formulas, [&](const Formula& each) { return each.key.starts_with(key); });
}

// Nothing where the state does not tell of it.
std::optional<double> value_in(const Solution& state, const Joint& joint, int index) {
  const auto found = std::ranges::find_if(state.coordinates, [&](const CoordinateSolution& c) {
    return c.joint == joint.name && c.index == index;
  });
  return found == state.coordinates.end() ? std::nullopt : std::optional(found->value);
}

// Its own spring goes on beside the one that pulls it to the place.
StandingJoint pull(Mechanism& mechanism, CoordinateReference at, std::size_t i, double value, double share,
                   double reach, double give) {
  Joint& joint = joint_of(mechanism, at);
  Coordinate& c = coordinate_of(mechanism, at);
  const auto index = static_cast<std::size_t>(at.coordinate);
  const bool angle = is_angle(joint.type, at.coordinate);
  const std::string unit = angle ? "rad" : "m", stiff = angle ? " N m/rad" : " N/m";
  const double limit = friction_limit(*c.friction), stiffness = limit / (give * (angle ? 1 : reach));
  remove_formulas(joint, coordinate_key(joint, index, "friction"));
  c.friction.reset();

  const std::string name = free_name(mechanism, i);
  const double place = value + share * limit / stiffness, far = farthest_place * (angle ? 1 : reach);
  mechanism.parameters.push_back(
      {.name = name, .description = {}, .value = place, .unit = unit, .range = {}});
  const std::string key = coordinate_key(joint, index, "spring");
  std::string own = "0" + stiff + "*deflection";
  double free = 0;
  if (c.spring) {
    free = c.spring->free;
    const Formula* law = spring_law(joint, at.coordinate);
    own = law               ? "(" + law->text + ")"
          : c.spring->force ? number_text(*c.spring->force) + (angle ? " N m" : " N")
                            : number_text(c.spring->stiffness) + stiff + "*deflection";
  }
  remove_formulas(joint, key);
  c.spring = CoordinateSpring{.stiffness = 0, .free = free, .force = 0};
  joint.formulas.push_back({key + ".force", own + " + " + number_text(stiffness) + stiff + "*(deflection + " +
                                                number_text(free) + " " + unit + " - " + name + ")"});
  const std::string measure = free_name(mechanism, i);
  mechanism.measures.push_back({.name = measure,
                                .description = {},
                                .text = number_text(stiffness / limit) + "/(1 " + unit + ")*(" + name +
                                        " - coordinate(" +
                                        coordinate_argument(coordinate_name(joint, at.coordinate)) + "))",
                                .unit = ""});
  return {{"parameters." + name, place - far, place + far},
          measure,
          coordinate_name(joint, at.coordinate),
          share_address(mechanism, at)};
}

} // namespace

std::optional<StandingJoints> stand_on_springs(const Mechanism& mechanism, const Solution& state,
                                               const std::vector<std::size_t>& independent, double reach,
                                               double give) {
  if (asks_for_springs(mechanism)) return std::nullopt;
  StandingJoints out{mechanism, {}};
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    const std::string address = share_address(mechanism, frictions[i]);
    const Friction& friction = friction_at(mechanism, frictions[i]);
    if (!(friction_limit(friction) > 0)) continue;
    const Joint& joint = joint_of(mechanism, frictions[i]);
    const int index = frictions[i].coordinate;
    if (std::ranges::find(independent, i) == independent.end()) {
      out.joints.push_back({{address, -1, 1}, {}, coordinate_name(joint, index), address});
      continue;
    }
    const std::optional<double> value = value_in(state, joint, index);
    if (!value) return std::nullopt;
    out.joints.push_back(pull(out.mechanism, frictions[i], i, *value, friction.share, reach, give));
  }
  return out;
}

std::vector<std::string> freely_turning(const Mechanism& mechanism, const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const Joint& joint : mechanism.joints) {
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      const Coordinate& c = joint.coordinates[i];
      const int index = static_cast<int>(i);
      const std::string name = coordinate_name(joint, index);
      if (c.drive && finds_speed(*c.drive) && asks_for_place(mechanism, joint, index)) return {};
      if (!c.spring && !c.stop) {
        if (is_angle(joint.type, index) && !is_rotation_vector(joint.type, index)) out.push_back(name);
      } else if (std::ranges::find(names, name) == names.end()) {
        return {};
      }
    }
  }
  return out;
}

} // namespace flyball
