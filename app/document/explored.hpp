// Numbers that were tried while exploring: they stand beside the document's mechanism, which they do not
// change until a person keeps them.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct ExploredValue {
  std::string address; // as in a scene file: "joints.spin.drive.speed"
  double value = 0;
  bool operator==(const ExploredValue&) const = default;
};
using Explored = std::vector<ExploredValue>; // each address once

// Nothing where there is no number at the address.
std::optional<double> find_number(const Mechanism& mechanism, const std::string& address);

// With one more number, in its place where the address is there; without the address where the mechanism has
// this value anyway, an expression gives it, or there is no such number.
void explore_value(Explored& explored, const Mechanism& mechanism, const std::string& address, double value);

// The mechanism with these numbers. Those that it does not have, or that expressions give, are ignored.
// Throws SceneError where expressions can make nothing of them.
Mechanism with_explored(Mechanism mechanism, const Explored& explored);

// The address after an edit that has renamed its part in its place; else as it is.
std::string renamed_address(const std::string& address, const Mechanism& before, const Mechanism& after);

// What is left of them after an edit: a number that the edit has set counts from then on, what is gone is
// gone, and a part that was renamed in its place keeps what is explored of it. What is explored of a number
// that the edit names is explored of the new parameter.
Explored carried_explored(const Explored& explored, const Mechanism& before, const Mechanism& after);

} // namespace flyball
