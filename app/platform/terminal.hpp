// The terminal that standard error goes to.
#pragma once

#include <optional>

namespace flyball {

// How many characters a line has, where there is one on which a line can be drawn over.
std::optional<int> terminal_columns();

} // namespace flyball
