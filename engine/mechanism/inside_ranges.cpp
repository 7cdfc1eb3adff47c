#include "engine/mechanism/inside_ranges.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flyball {

std::optional<Mechanism> inside_ranges(const Mechanism& mechanism, std::span<const NumberRange> ranges) {
  std::vector<ParameterValue> values;
  for (const NumberRange& range : ranges) {
    const auto [least, most] = std::minmax(range.from, range.to);
    double value = get_parameter(mechanism, range.address);
    const double width = most - least;
    if (!(value > least && value < most) || value == 0) {
      value = least + 0.37 * width;
      if (std::abs(value) < 1e-3 * width) value = least + 0.63 * width;
    }
    values.push_back({range.address, value});
  }
  std::optional<Mechanism> inside(mechanism);
  try {
    set_parameters(*inside, values);
  } catch (const SceneError&) {
    return std::nullopt;
  }
  return inside;
}

} // namespace flyball
