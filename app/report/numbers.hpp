// Numbers with their units, set as in print: "−1.2 × 10⁻⁷ m".
#pragma once

#include "app/report/html.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/open_directions.hpp"

namespace flyball {

// A number as text, with a true minus sign and powers of ten set high.
Html written_number(std::string_view number);
// At most `digits` significant digits; `unit` as in scene files ("m/s^2"), empty for a plain number.
Html quantity(double value, std::string_view unit, int digits = 6);
// No more digits than the error leaves.
Html quantity_within(double value, double error, std::string_view unit);
// A magnitude, such as an error: two digits.
Html magnitude(double value, std::string_view unit);
// Components that are open (solve/open_directions.hpp) are marked by ≈.
Html vector_quantity(const Vec3& v, std::string_view unit, int digits = 6, const OpenDirections& open = {});
// In a unit, "rad", "(rad/s)", per that of the number at `address`.
Html rate_quantity(const Mechanism& mechanism, double rate, std::string_view of, std::string_view address);
// A run time; what a run is told by the clock stands in <time>.
Html duration(double seconds);

std::string_view coordinate_unit_of(bool angle); // "rad", "m"
std::string_view force_unit_of(bool angle);      // "N m", "N"

} // namespace flyball
