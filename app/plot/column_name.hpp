// Columns of tables, as CSV and for NumPy.
#pragma once

#include <string>

namespace flyball {

// What a coordinate or measure has as its column: its name, with "_" behind one that tables have columns of
// their own for.
std::string column_name(const std::string& name);

} // namespace flyball
