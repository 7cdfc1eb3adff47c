// Edits of named parameters, points and expressions. All throw SceneError, and leave the mechanism as it was,
// where they cannot be done.
//
// An address is one of expressible_number, or of a body's turn about a world axis, "bodies.arm.turn.2", which
// is given by expressions of its rotation (see turns.hpp).
#pragma once

#include "engine/mechanism/formulas.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// The expression that gives the number at an address; nothing for a number by itself.
std::optional<std::string> expression_at(const Mechanism& mechanism, const std::string& address);
// Its value, in SI units and radians.
double expressed_value(const Mechanism& mechanism, const std::string& address);
// The number at an address is given by an expression from now on (without its "="), or, where that is empty,
// stays by itself what it is. One of the deflection or rate, given for a stiffness or damping, is the law of
// the whole force in its place (force_law.hpp). Refuses laws that cannot be read or ask for what is not
// there.
void set_expression(Mechanism& mechanism, const std::string& address, const std::string& text);
// The parameter that set_expression() would lack alone, in the first of the usual units with which the
// expression can be: of the value with which the number stays what it is, where it alone is the expression
// and that value is allowed, or the expression is linear in it and that is above zero; else of the value 1.
// Nothing where it lacks something else.
std::optional<NamedParameter> lacking_parameter(const Mechanism& mechanism, const std::string& address,
                                                const std::string& text);
// It is by itself this value (SI units, radians) from now on.
void set_by_itself(Mechanism& mechanism, const std::string& address, double value);
// The expressions of a vector's three numbers ("joints.spin.at"): it stands at a named point.
void stand_at_point(Mechanism& mechanism, const std::string& vector, const std::string& point);
// A named point where a vector is, at which it stands from then on.
void name_place(Mechanism& mechanism, const std::string& vector, const std::string& name);
// A named parameter of the number's value and unit, by which the number is given from then on.
void name_number(Mechanism& mechanism, const std::string& address, const std::string& name);
// A name that no parameter, point or measure has: the wish, or with a figure behind it.
std::string free_name(const Mechanism& mechanism, const std::string& wish);

// Expressions, measures and sliders follow.
void rename_parameter(Mechanism& mechanism, const std::string& name, const std::string& to);
void rename_point(Mechanism& mechanism, const std::string& name, const std::string& to);
// What it gave stays what it is, by itself where the expression cannot do without. Laws and measures have the
// parameter's value instead. Without a point measures that are about it are dropped; one that a law names
// stays.
void remove_parameter(Mechanism& mechanism, const std::string& name);
void remove_point(Mechanism& mechanism, const std::string& name);
// Addresses of the numbers whose expressions name it, and of measures.
std::vector<std::string> users_of(const Mechanism& mechanism, std::string_view name);

// After an edit of `before` that has set numbers which expressions give: the numbers that these rest on are
// changed so that it is so, where they are determined by it (dragging a joint that stands at a point moves
// the point, and all else that stands there). Parts that are new keep their expressions where these mean
// the same, as copies do that stand at the same place. Expressions are evaluated. Throws SceneError that
// says what gives the number where it cannot be so; where expressions had mistakes before, only if there are
// more of them now.
void settle_formulas(const Mechanism& before, Mechanism& next);

} // namespace flyball
