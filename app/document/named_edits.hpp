// Edits of named parameters and points. All throw SceneError, and leave the mechanism as it was, where they
// cannot be done. Addresses are those of formula_edits.hpp.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// A named point where a vector is, at which it stands from then on.
void name_place(Mechanism& mechanism, const std::string& vector, const std::string& name);
// A named parameter of the number's value and unit, by which the number is given from then on.
void name_number(Mechanism& mechanism, const std::string& address, const std::string& name);
// The parameter that set_expression() would lack alone, in the first of the usual units with which the
// expression can be: of the value with which the number stays what it is, where it alone is the expression
// and that value is allowed, or the expression is linear in it and that is above zero; else of the value 1.
// Nothing where it lacks something else.
std::optional<NamedParameter> lacking_parameter(const Mechanism& mechanism, const std::string& address,
                                                const std::string& text);
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

} // namespace flyball
