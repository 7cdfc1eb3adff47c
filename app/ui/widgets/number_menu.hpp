// What can be done with a number of the scene beside typing it: a name, a named point, its address.
#pragma once

#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/typed_field.hpp"

namespace flyball {

// Where the number's expression is kept; empty: it takes none.
const std::string& place_of(const QuantityField& field);
// The vector of which the field shows one of three coordinates; empty: of none that could stand at a point.
std::string vector_of(const QuantityField& field);
// The expression that gives the number, or nothing.
std::optional<std::string> formula_of(const Session& session, const QuantityField& field);

// The field's place for the name that its number was just given, in which another is typed.
std::string naming_field(const std::string& field);
// The field of a name, in which it is given another one.
using Rename = void (*)(Mechanism&, const std::string& name, const std::string& to);
TextField name_text_field(Session& session, const std::string& widget, const std::string& name,
                          Rename rename);

// `asked` for by the right button, or by the menu key.
void number_menu(Session& session, Ui& ui, const QuantityField& field, bool asked);

} // namespace flyball
