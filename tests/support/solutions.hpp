// What was found of one coordinate.
#pragma once

#include "engine/solve/solution.hpp"

#include <string_view>
#include <vector>

namespace flyball::test {

// Throws where there is none.
const CoordinateSolution& coordinate(const std::vector<CoordinateSolution>& all, std::string_view joint,
                                     int index = 0);
double value(const std::vector<CoordinateSolution>& all, std::string_view joint, int index = 0); // rad or m

// The same of a solution, which says why there is none.
const CoordinateSolution& coordinate(const Solution& solution, std::string_view joint, int index = 0);
double value(const Solution& solution, std::string_view joint, int index = 0);

} // namespace flyball::test
