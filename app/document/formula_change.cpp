#include "app/document/formula_change.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/numbers.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

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

void put_turn(Mechanism& mechanism, TurnPlace place, const std::string& address, const std::string& text) {
  if (!text.empty()) { // in its own words before it is part of a longer one
    const double angle = evaluate_expression(mechanism, text, "rad", address);
    place.turns.angles[static_cast<Eigen::Index>(place.axis)] = angle * 180 / std::numbers::pi;
  }
  place.turns.texts[place.axis] = text;
  set_turns(*place.body, place.turns);
}

} // namespace

bool take_with_mistakes(const Mechanism& before, Mechanism& next) {
  Mechanism former = before;
  try {
    evaluate_formulas(former);
    return false;
  } catch (const SceneError&) {
    return evaluate_what_can_be(next) <= evaluate_what_can_be(former);
  }
}

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

void put_expression(Mechanism& mechanism, const std::string& address, const std::string& text) {
  if (TurnPlace turn = turn_place(mechanism, address); turn.body)
    return put_turn(mechanism, std::move(turn), address, text);
  const auto [formulas, key] = formula_place(mechanism, address);
  if (!formulas) throw SceneError(address, "there is no such number");
  std::erase_if(*formulas, [&key = key](const Formula& formula) { return formula.key == key; });
  if (!text.empty()) formulas->push_back({std::string(key), text});
  std::ranges::sort(*formulas, {}, &Formula::key); // as a file is read
}

bool mentions(std::string_view text, std::string_view name) {
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

} // namespace flyball
