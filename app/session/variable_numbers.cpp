#include "app/session/variable_numbers.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>

namespace flyball {

std::vector<std::string> variable_numbers(const Session& session, Dampers dampers) {
  constexpr std::size_t many = 60; // bodies
  std::vector<std::string> all;
  const bool with = dampers == Dampers::with;
  for (const ParameterControl& control : session.parameters)
    if (with || control.group != ParameterGroup::dampers) all.push_back(control.address);
  if (session.mechanism().bodies.size() > many) return all;
  for (const std::string& address : parameter_addresses(session.mechanism()))
    if (!address.starts_with("simulation.") && (with || address.find(".damping") == std::string::npos) &&
        std::ranges::find(all, address) == all.end())
      all.push_back(address);
  return all;
}

std::optional<ParameterControl> control_of(const Session& session, const std::string& address) {
  const auto found = std::ranges::find(session.parameters, address, &ParameterControl::address);
  if (found != session.parameters.end()) return *found;
  return number_control(session.mechanism(), session.document.stored(), address, session.units);
}

} // namespace flyball
