// Edits of the expressions that give numbers. All throw SceneError, and leave the mechanism as it was,
// where they cannot be done.
//
// An address is one of expressible_number, or of a body's turn about a world axis, "bodies.arm.turn.2", which
// is given by expressions of its rotation (see turns.hpp).
#pragma once

#include "engine/mechanism/formulas.hpp"

#include <optional>
#include <string>

namespace flyball {

// The expression that gives the number at an address; nothing for a number by itself.
std::optional<std::string> expression_at(const Mechanism& mechanism, const std::string& address);
// Its value, in SI units and radians.
double expressed_value(const Mechanism& mechanism, const std::string& address);
// And its unit, "" for a number without.
std::string expressed_unit(const Mechanism& mechanism, const std::string& address);
// The number at an address is given by an expression from now on (without its "="), or, where that is empty,
// stays by itself what it is. One of the deflection or rate, given for a stiffness or damping, is the law of
// the whole force in its place (force_law.hpp). Refuses laws that cannot be read or ask for what is not
// there.
void set_expression(Mechanism& mechanism, const std::string& address, const std::string& text);
// It is by itself this value (SI units, radians) from now on.
void set_by_itself(Mechanism& mechanism, const std::string& address, double value);
// The expressions of a vector's three numbers ("joints.spin.at"): it stands at a named point.
void stand_at_point(Mechanism& mechanism, const std::string& vector, const std::string& point);

} // namespace flyball
