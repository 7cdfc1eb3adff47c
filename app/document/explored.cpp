#include "app/document/explored.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"

#include <algorithm>
#include <optional>

namespace flyball {

namespace {

// The part's name in the list after the edit, where only names have changed there.
template <class Part>
std::string renamed(const std::string& name, const std::vector<Part>& before,
                    const std::vector<Part>& after) {
  if (before.size() != after.size() || std::ranges::find(after, name, &Part::name) != after.end())
    return name;
  const auto at = std::ranges::find(before, name, &Part::name);
  return at == before.end() ? name : after[static_cast<std::size_t>(at - before.begin())].name;
}

// The parameter that gives the number since the edit, where the edit has made it for that.
std::string named_address(const std::string& address, const Mechanism& before, const Mechanism& after) {
  const std::optional<std::string> formula = formula_at(after, address);
  const bool is_new =
      formula && parameter_index(after, *formula) >= 0 && parameter_index(before, *formula) < 0;
  return is_new ? "parameters." + *formula : address;
}

} // namespace

std::optional<double> find_number(const Mechanism& mechanism, const std::string& address) {
  try {
    return get_parameter(mechanism, address);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

std::string renamed_address(const std::string& address, const Mechanism& before, const Mechanism& after) {
  const std::size_t begin = address.find('.'), end = address.find('.', begin + 1);
  if (begin == std::string::npos) return address;
  const std::string list = address.substr(0, begin), name = address.substr(begin + 1, end - begin - 1);
  std::string now = name;
  if (list == "bodies") now = renamed(name, before.bodies, after.bodies);
  if (list == "joints") now = renamed(name, before.joints, after.joints);
  if (list == "forces") now = renamed(name, before.forces, after.forces);
  if (list == "parameters") now = renamed(name, before.parameters, after.parameters);
  if (list == "points") now = renamed(name, before.points, after.points);
  return list + "." + now + (end == std::string::npos ? "" : address.substr(end));
}

void explore_value(Explored& explored, const Mechanism& mechanism, const std::string& address, double value) {
  const std::optional<double> present = find_number(mechanism, address);
  const auto found = std::ranges::find(explored, address, &ExploredValue::address);
  if (!present || *present == value || formula_at(mechanism, address)) {
    if (found != explored.end()) explored.erase(found);
  } else if (found != explored.end()) {
    found->value = value;
  } else {
    explored.push_back({address, value});
  }
}

Mechanism with_explored(Mechanism mechanism, const Explored& explored) {
  std::vector<ParameterValue> there;
  for (const ExploredValue& each : explored)
    if (find_number(mechanism, each.address) && !formula_at(mechanism, each.address))
      there.push_back({each.address, each.value});
  set_parameters(mechanism, there);
  return mechanism;
}

Explored carried_explored(const Explored& explored, const Mechanism& before, const Mechanism& after) {
  Explored left;
  for (const ExploredValue& each : explored) {
    const std::string address = named_address(renamed_address(each.address, before, after), before, after);
    if (find_number(before, each.address) == find_number(after, address))
      explore_value(left, after, address, each.value);
  }
  return left;
}

} // namespace flyball
