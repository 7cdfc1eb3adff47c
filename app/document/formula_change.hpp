// What edits of expressions are made of.
#pragma once

#include "app/document/turns.hpp"
#include "engine/mechanism/formulas.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace flyball {

// Takes an edit in spite of mistakes in expressions that were there before, if it makes no more of them; what
// has a value is evaluated. So mistakes can be mended one after the other, and the rest be built before that.
bool take_with_mistakes(const Mechanism& before, Mechanism& next);

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

TurnPlace turn_place(Mechanism& mechanism, const std::string& address);

// The number at an address is given by `text`, or by itself where that is empty; nothing is evaluated.
// Throws SceneError where there is no such number.
void put_expression(Mechanism& mechanism, const std::string& address, const std::string& text);

// Whether an expression names a parameter or point.
bool mentions(std::string_view text, std::string_view name);

} // namespace flyball
