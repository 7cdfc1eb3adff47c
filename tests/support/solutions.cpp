#include "tests/support/solutions.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace flyball::test {

const CoordinateSolution& coordinate(const std::vector<CoordinateSolution>& all, std::string_view joint,
                                     int index) {
  const auto found = std::ranges::find_if(
      all, [&](const CoordinateSolution& c) { return c.joint == joint && c.index == index; });
  if (found == all.end()) throw std::runtime_error("no coordinate " + std::string(joint));
  return *found;
}

double value(const std::vector<CoordinateSolution>& all, std::string_view joint, int index) {
  return coordinate(all, joint, index).value;
}

const CoordinateSolution& coordinate(const Solution& solution, std::string_view joint, int index) {
  if (solution.coordinates.empty()) throw std::runtime_error(solution.message);
  return coordinate(solution.coordinates, joint, index);
}

double value(const Solution& solution, std::string_view joint, int index) {
  return coordinate(solution, joint, index).value;
}

} // namespace flyball::test
