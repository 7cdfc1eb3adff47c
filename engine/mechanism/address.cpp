#include "engine/mechanism/address.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/numbers.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/varied_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

std::string_view first_segment(std::string_view address) {
  return address.substr(0, address.find('.'));
}

std::string_view after_first_segment(std::string_view address) {
  const std::size_t dot = address.find('.');
  return dot == std::string_view::npos ? std::string_view() : address.substr(dot + 1);
}

// Says which segment of `key` is the first that no number has, and what could stand there.
[[noreturn]] void fail_number(std::string path, std::string_view key, const std::vector<Number>& numbers) {
  std::vector<std::string_view> rests;
  for (const Number& number : numbers)
    rests.push_back(number.key);
  for (;;) {
    std::vector<std::string_view> options;
    for (const std::string_view rest : rests)
      if (std::find(options.begin(), options.end(), first_segment(rest)) == options.end())
        options.push_back(first_segment(rest));
    const std::string what_exists = "; what exists: " + word_list(options, "and");
    if (key.empty()) throw SceneError(path, "this names no number yet" + what_exists);
    const std::string_view segment = first_segment(key);
    path += (path.empty() ? "" : ".") + std::string(segment);
    if (options.size() == 1 && options[0].empty())
      throw SceneError(path, "expected the address to end before \"" + std::string(segment) + "\"");
    if (std::find(options.begin(), options.end(), segment) == options.end())
      throw SceneError(path, "there is no \"" + std::string(segment) + "\" here" + what_exists +
                                 did_you_mean(segment, options));
    std::erase_if(rests, [&](std::string_view rest) { return first_segment(rest) != segment; });
    for (std::string_view& rest : rests)
      rest = after_first_segment(rest);
    key = after_first_segment(key);
  }
}

Number find_number(const std::string& path, std::string_view key, std::vector<Number> numbers) {
  const auto found =
      std::find_if(numbers.begin(), numbers.end(), [&](const Number& n) { return n.key == key; });
  if (found == numbers.end()) fail_number(path, key, numbers);
  return std::move(*found);
}

template <class Part>
[[noreturn]] void fail_part(std::string_view list_name, std::string_view name,
                            const std::vector<Part>& parts) {
  std::vector<std::string_view> names;
  for (const Part& part : parts)
    names.push_back(part.name);
  const std::string where = std::string(list_name) + (name.empty() ? "" : "." + std::string(name));
  if (names.empty()) throw SceneError(where, "the mechanism has no " + std::string(list_name));
  throw SceneError(where, "expected one of " + word_list(names) + did_you_mean(name, names));
}

template <class List>
auto& find_part(std::string_view list_name, std::string_view name, List& parts) {
  const auto found =
      std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.name == name; });
  if (found == parts.end()) fail_part(list_name, name, parts);
  return *found;
}

// The part itself, or a copy where it cannot be changed.
template <class Part>
Part& changeable(Part& part) {
  return part;
}
template <class Part>
Part changeable(const Part& part) {
  return part;
}

// For a const mechanism only the number's value and unit are good.
template <class AMechanism>
Number find_number(AMechanism& mechanism, std::string_view address) {
  const std::string_view list = first_segment(address);
  const std::string_view name = first_segment(after_first_segment(address));
  const std::string_view key = after_first_segment(after_first_segment(address));
  const std::string path = std::string(list) + "." + std::string(name);
  if (list == "bodies") {
    auto&& body = changeable(find_part(list, name, mechanism.bodies));
    return find_number(path, key, numbers_of(body));
  }
  if (list == "joints") {
    auto&& joint = changeable(find_part(list, name, mechanism.joints));
    return find_number(path, key, numbers_of(mechanism, joint));
  }
  if (list == "forces") {
    auto&& force = changeable(find_part(list, name, mechanism.forces));
    return find_number(path, key, numbers_of(mechanism, force));
  }
  if (list == "gravity") {
    auto&& gravity = changeable(mechanism.gravity);
    return find_number("", address, numbers_of_gravity(gravity));
  }
  if (list == "air") {
    auto&& air = changeable(mechanism.air);
    return find_number("", address, numbers_of(air));
  }
  if (list == "simulation") {
    auto&& simulation = changeable(mechanism.simulation);
    return find_number("", address, numbers_of(simulation));
  }
  if (list == "parameters") { // "parameters.L" is its value
    auto&& parameter = changeable(find_part(list, name, mechanism.parameters));
    if (!key.empty())
      throw SceneError(path + "." + std::string(key), "expected the address to end before this");
    return std::move(numbers_of(parameter).front());
  }
  if (list == "points") {
    auto&& point = changeable(find_part(list, name, mechanism.points));
    return find_number(path, key, numbers_of(point));
  }
  constexpr std::array<std::string_view, 8> starts{"parameters", "points", "gravity", "air",
                                                   "bodies",     "joints", "forces",  "simulation"};
  throw SceneError(std::string(address),
                   "expected an address that begins with " + word_list(starts) + did_you_mean(list, starts));
}

// Of those that no expression gives.
void append_addresses(std::vector<std::string>& all, const std::string& prefix,
                      const std::vector<Number>& numbers, const Formulas& formulas) {
  for (const Number& number : numbers)
    if (std::ranges::find(formulas, number.key, &Formula::key) == formulas.end())
      all.push_back(prefix + number.key);
}

} // namespace

double get_parameter(const Mechanism& mechanism, std::string_view address) {
  return find_number(mechanism, address).value;
}

void set_parameter(Mechanism& mechanism, std::string_view address, double value) {
  const ParameterValue one{std::string(address), value};
  set_parameters(mechanism, {&one, 1});
}

void set_parameters(Mechanism& mechanism, std::span<const ParameterValue> values) {
  std::vector<std::string> addresses;
  std::vector<double> numbers;
  for (const auto& [address, value] : values) {
    addresses.push_back(address);
    numbers.push_back(value);
  }
  VariedNumbers(mechanism, addresses).set(numbers);
}

Number addressed_number(Mechanism& mechanism, std::string_view address) {
  return find_number(mechanism, address);
}

void put_number(Mechanism& mechanism, std::string_view address, double value) {
  find_number(mechanism, address).set(value);
}

bool has_number(const Mechanism& mechanism, std::string_view address) {
  try {
    find_number(mechanism, address);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

std::string parameter_unit(const Mechanism& mechanism, std::string_view address) {
  return find_number(mechanism, address).unit;
}

std::string coordinate_key(const Joint& joint, std::size_t i, std::string_view part) {
  return std::string(part) + (joint.coordinates.size() > 1 ? "." + std::to_string(i) : "");
}

std::string drive_speed_address(const Joint& joint, std::size_t i) {
  return "joints." + joint.name + "." + coordinate_key(joint, i, "drive") + ".speed";
}

std::vector<std::string> parameter_addresses(const Mechanism& mechanism) {
  Mechanism copy = mechanism;
  std::vector<std::string> all;
  for (const NamedParameter& parameter : copy.parameters)
    if (parameter.formulas.empty()) all.push_back("parameters." + parameter.name);
  for (NamedPoint& point : copy.points)
    append_addresses(all, "points." + point.name + ".", numbers_of(point), point.formulas);
  append_addresses(all, "", numbers_of_gravity(copy.gravity), copy.formulas);
  append_addresses(all, "", numbers_of(copy.air), copy.formulas);
  for (Body& body : copy.bodies)
    append_addresses(all, "bodies." + body.name + ".", numbers_of(body), body.formulas);
  for (Joint& joint : copy.joints)
    append_addresses(all, "joints." + joint.name + ".", numbers_of(mechanism, joint), joint.formulas);
  for (Force& force : copy.forces)
    append_addresses(all, "forces." + force.name + ".", numbers_of(mechanism, force), force.formulas);
  append_addresses(all, "", numbers_of(copy.simulation), copy.formulas);
  return all;
}

} // namespace flyball
