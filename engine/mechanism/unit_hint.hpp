// Help where the symbol of a unit stands in the place of a name.
#pragma once

#include <string>
#include <string_view>

namespace flyball {

// "; units ..." for the symbol of a unit where the name of a number is expected, as the m of 2 N*m; else
// empty.
std::string unit_hint(std::string_view name);

} // namespace flyball
