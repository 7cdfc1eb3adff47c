#include "app/document/formula_edits.hpp"

#include "app/document/formula_change.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/numbers.hpp"

#include <algorithm>
#include <numbers>

namespace flyball {

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

std::string expressed_unit(const Mechanism& mechanism, const std::string& address) {
  Mechanism& looked_at = const_cast<Mechanism&>(mechanism); // no more
  return turn_place(looked_at, address).body ? "rad" : expressible_number(looked_at, address).unit;
}

void set_by_itself(Mechanism& mechanism, const std::string& address, double value) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    if (TurnPlace turn = turn_place(next, address); turn.body) {
      turn.turns.texts[turn.axis].clear();
      turn.turns.angles[static_cast<Eigen::Index>(turn.axis)] = value * 180 / std::numbers::pi;
      return set_turns(*turn.body, turn.turns);
    }
    put_expression(next, address, "");
    expressible_number(next, address).set(value);
  });
}

namespace {

// An expression of the deflection or rate is the whole force: it stands in the place of the stiffness or
// damping that it was given for. False where it is none.
bool put_law(Mechanism& mechanism, const std::string& address, const std::string& text) {
  const auto [formulas, key] = formula_place(mechanism, address);
  if (!formulas) return false;
  const bool spring =
      key.ends_with("stiffness") && !key.starts_with("stop") && mentions(text, spring_variable);
  if (!spring && !(key.starts_with("damping") && mentions(text, damper_variable))) return false;
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
    if (!put_law(next, address, text)) put_expression(next, address, text);
    check_drive_laws(next, address);
  });
}

void stand_at_point(Mechanism& mechanism, const std::string& vector, const std::string& point) {
  all_or_nothing(mechanism, [&](Mechanism& next) {
    for (const int i : {0, 1, 2})
      put_expression(next, vector + "." + std::to_string(i), point_coordinate(point, i));
  });
}

} // namespace flyball
