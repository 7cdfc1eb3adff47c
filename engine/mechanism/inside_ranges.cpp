#include "engine/mechanism/inside_ranges.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/unit.hpp"
#include "engine/mechanism/varied_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flyball {
namespace {

constexpr int places = 100; // of ranges at which what is zero inside them is looked for

// Of a damper, mass, stiffness, force or weight, in contrast to where things are.
bool is_load(const GivenNumber& number) {
  if (number.address.starts_with("parameters.") || number.address.find(".drive.") != std::string::npos)
    return false; // which compiling does not ask for
  const std::optional<Unit> unit = parse_unit(number.unit);
  return unit && (unit->dimension.mass != 0 || unit->dimension == Dimension{1, 0, -2, 0});
}

// Both ends, and then places spread evenly, of several ranges not in step: multiples of 2^(1/2), 2^(1/3), ...
// without their whole parts.
double value_at(const NumberRange& range, std::size_t axis, int place) {
  const double way = std::exp2(1 / (2 + static_cast<double>(axis))) * place;
  return range.from + (place < 2 ? place : way - std::floor(way)) * (range.to - range.from);
}

void set_absent_loads(Mechanism& inside, std::span<const NumberRange> ranges) {
  std::vector<bool> absent; // by given_numbers()
  for (const GivenNumber& number : given_numbers(inside))
    absent.push_back(number.value == 0 && is_load(number));
  const auto some = [&] { return std::ranges::find(absent, true) != absent.end(); };
  if (!some()) return;
  std::vector<std::string> addresses;
  for (const NumberRange& range : ranges)
    addresses.push_back(range.address);
  Mechanism there(inside);
  VariedNumbers numbers(there, addresses);
  std::vector<double> values(ranges.size());
  for (int place = 0; place < places && some(); ++place) {
    for (std::size_t i = 0; i < ranges.size(); ++i)
      values[i] = value_at(ranges[i], i, place);
    try {
      numbers.set(values);
    } catch (const SceneError&) { // no mechanism can be made of them
      continue;
    }
    const std::vector<GivenNumber> now = given_numbers(there);
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (!absent[i] || now[i].value == 0) continue;
      put_number(inside, now[i].address, now[i].value);
      absent[i] = false;
    }
  }
}

} // namespace

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
  set_absent_loads(*inside, ranges);
  return inside;
}

Mechanism with_dampers_beside(const Mechanism& mechanism, std::span<const std::string> addresses) {
  Mechanism out(mechanism);
  const VariedNumbers numbers(out, addresses);
  std::vector<double*> absent;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    NumberRates rates;
    try {
      numbers.rates(i, rates);
    } catch (const SceneError&) { // that are infinite: whoever asks for them hears of it
      continue;
    }
    for (Joint& joint : out.joints)
      for (Coordinate& c : joint.coordinates)
        if (c.damping == 0 && rates.find(place_of(c.damping)).value_or(0) != 0) absent.push_back(&c.damping);
  }
  for (double* damping : absent)
    *damping = 1;
  return out;
}

} // namespace flyball
