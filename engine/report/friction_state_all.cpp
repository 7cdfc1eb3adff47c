#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_state.hpp"
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

bool is_known(const Solution& state, const std::vector<Solution>& states) {
  return std::ranges::any_of(states, [&](const Solution& other) {
    return scaled_distance(state.coordinates, other.coordinates) < tolerance::same_state;
  });
}

bool some_speed_is_found(const std::vector<CoordinateSolution>& coordinates) {
  return std::ranges::any_of(coordinates, [](const CoordinateSolution& c) { return c.speed.has_value(); });
}

// All that a search finds with these parts, where speeds are found.
void add_states_with(const Mechanism& mechanism, const FrictionParts& parts, const SolveOptions& options,
                     std::vector<Solution>& out) {
  SolveOptions search = options;
  search.friction = search.details = search.explain = false;
  std::vector<Solution> states;
  try {
    Analysis driven(driven_by_parts(mechanism, find_frictions(mechanism), parts));
    if (!some_speed_is_found(driven.summary().coordinates)) return;
    states = driven.solve_all(search).equilibria;
  } catch (const SceneError&) { // drives that close a loop, say
    return;
  }
  SolveOptions from = options;
  from.nearest = true;
  for (const Solution& there : states) {
    from.start = start_at(there);
    auto state = solve_with_parts(mechanism, parts, from);
    if (state && state->goes && !is_known(state->solution, out)) out.push_back(std::move(state->solution));
  }
}

} // namespace

std::vector<Solution> find_friction_states(const Mechanism& mechanism, const SolveOptions& options) {
  const std::vector<FrictionParts> all = friction_parts(mechanism, options.cancel);
  SolveOptions plain = options;
  plain.start.clear();
  plain.search_time /= static_cast<double>(all.size());
  std::vector<Solution> out;
  std::vector<FrictionParts> found;
  for (const FrictionParts& parts : all) {
    if (std::ranges::any_of(found, [&](const FrictionParts& other) { return holds_more(other, parts); }))
      continue; // in the band of that
    const std::size_t before = out.size();
    if (auto state = solve_with_parts(mechanism, parts, plain); state && state->goes)
      out.push_back(std::move(state->solution));
    add_states_with(mechanism, parts, plain, out);
    if (out.size() > before) found.push_back(parts);
  }
  if (!out.empty() || tries_all_parts(mechanism)) return out;
  if (auto state = find_friction_state(mechanism, plain)) out.push_back(std::move(state->solution));
  return out;
}

} // namespace flyball
