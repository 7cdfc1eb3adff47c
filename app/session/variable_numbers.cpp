#include "app/session/variable_numbers.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>

namespace flyball {

namespace {

// A torque turns its body wherever it acts.
bool is_place_of_torque(const Mechanism& mechanism, const std::string& address) {
  return std::ranges::any_of(mechanism.forces, [&](const Force& force) {
    return force.type == ForceType::torque && address.starts_with("forces." + force.name + ".at.");
  });
}

} // namespace

bool finds_speeds(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints, [](const Joint& joint) {
    return std::ranges::any_of(joint.coordinates,
                               [](const Coordinate& c) { return c.drive && finds_speed(*c.drive); });
  });
}

std::vector<std::string> variable_numbers(const Session& session, Dampers dampers) {
  constexpr std::size_t many = 60; // bodies
  std::vector<std::string> all;
  const bool with = dampers == Dampers::with;
  for (const ParameterControl& control : session.parameters)
    if (with || control.group != ParameterGroup::dampers) all.push_back(control.address);
  if (session.mechanism().bodies.size() > many) return all;
  for (const std::string& address : parameter_addresses(session.mechanism()))
    if (!address.starts_with("simulation.") && (with || address.find(".damping") == std::string::npos) &&
        !is_place_of_torque(session.mechanism(), address) && std::ranges::find(all, address) == all.end())
      all.push_back(address);
  return all;
}

std::optional<ParameterControl> control_of(const Session& session, const std::string& address) {
  const auto found = std::ranges::find(session.parameters, address, &ParameterControl::address);
  if (found != session.parameters.end()) return *found;
  return number_control(session.mechanism(), session.document.stored(), address, session.units);
}

} // namespace flyball
