// What can be done with a number of the scene beside typing it: a name, a named point, its address.
#pragma once

#include "app/ui/widgets/quantity_field.hpp"

namespace flyball {

// Where the number's expression is kept; empty: it takes none.
const std::string& place_of(const QuantityField& field);
// The vector of which the field shows one of three coordinates; empty: of none that could stand at a point.
std::string vector_of(const QuantityField& field);
// The expression that gives the number, or nothing.
std::optional<std::string> formula_of(const Session& session, const QuantityField& field);

// `asked` for by the right button, or by the menu key.
void number_menu(Session& session, Ui& ui, const QuantityField& field, bool asked);

} // namespace flyball
