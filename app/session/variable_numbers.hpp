// Which numbers studies can vary: every number of the mechanism, those with a slider first.
#pragma once

#include "app/session/parameter_list.hpp"

#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

// Whether dampers are among them, which move no steady state but decide about stability.
enum class Dampers { without, with };

// Whether some drive gives a torque or keeps its momentum, so that dampers move the steady state.
bool finds_speeds(const Mechanism& mechanism);
// Addresses: those with a slider, then every other number unless there are very many bodies.
std::vector<std::string> variable_numbers(const Session& session, Dampers dampers);
// The number's slider, or one that suits it where it has none; none where there is no such number, or an
// expression gives it.
std::optional<ParameterControl> control_of(const Session& session, const std::string& address);

} // namespace flyball
