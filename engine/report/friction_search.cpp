#include "engine/report/friction_search.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/solve/tolerances.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Where Newton-Raphson begins to come to a state.
std::vector<std::pair<std::string, double>> start_at(const Solution& state) {
  std::vector<std::pair<std::string, double>> out;
  for (const CoordinateSolution& c : state.coordinates)
    if (const std::optional<FoundNumber> number = found_number(c); number && !c.dependent)
      out.emplace_back(number->name, number->value);
  return out;
}

bool some_speed_is_found(const std::vector<CoordinateSolution>& coordinates) {
  return std::ranges::any_of(coordinates, [](const CoordinateSolution& c) { return c.speed.has_value(); });
}

// Of the mechanism that is driven as the parts say; the drives give rates as they first can.
std::vector<Solution> states_of_driven(const Mechanism& mechanism, const FrictionParts& parts,
                                       const SolveOptions& options) {
  SolveOptions search = options;
  search.start.clear();
  search.friction = search.details = search.explain = false;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (const std::vector<bool>& implied : implied_ways(mechanism, frictions, parts)) {
    try {
      Analysis driven(driven_by_parts(mechanism, frictions, parts, implied));
      if (!some_speed_is_found(driven.summary().coordinates)) continue;
      if (auto found = driven.solve_all(search).equilibria; !found.empty()) return found;
    } catch (const SceneError&) { // drives that close a loop, say
    }
  }
  return {};
}

} // namespace

bool is_among(const Solution& state, const std::vector<Solution>& states) {
  return std::ranges::any_of(states, [&](const Solution& other) {
    return scaled_distance(state.coordinates, other.coordinates) < tolerance::same_state;
  });
}

std::vector<StateOnFriction> find_states_with(const Mechanism& mechanism, const FrictionParts& parts,
                                              const SolveOptions& options) {
  SolveOptions from = options;
  from.nearest = true;
  std::vector<StateOnFriction> out;
  for (const Solution& there : states_of_driven(mechanism, parts, options)) {
    if (is_cancelled(options.cancel)) break;
    from.start = start_at(there);
    auto state = solve_with_parts(mechanism, parts, from);
    if (state && state->goes) out.push_back(std::move(*state));
  }
  return out;
}

} // namespace flyball
