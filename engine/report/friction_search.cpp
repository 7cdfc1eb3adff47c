#include "engine/report/friction_search.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/report/solve_with_parts.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/solve/tolerances.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double all_searches = 5; // together, of the time of one
constexpr double short_search = 0.1;

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

// The mechanism driven as the parts say, in all ways in which the drives may give rates.
std::vector<Analysis> driven_ways(const Mechanism& mechanism, const FrictionParts& parts) {
  const bool slips = std::ranges::any_of(parts, is_slipping);
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  std::vector<Analysis> out;
  for (const std::vector<bool>& implied : implied_ways(mechanism, frictions, parts)) {
    try {
      Analysis driven(driven_by_parts(mechanism, frictions, parts, implied));
      if (slips || some_speed_is_found(driven.summary().coordinates)) out.push_back(std::move(driven));
    } catch (const SceneError&) { // drives that close a loop, say
    }
  }
  return out;
}

std::vector<Solution> states_of(Analysis& driven, const SolveOptions& options) {
  SolveOptions search = options;
  search.start.clear();
  search.friction = search.details = search.explain = false;
  try {
    return driven.solve_all(search).equilibria;
  } catch (const SceneError&) { // laws that give no number somewhere
    return {};
  }
}

// That to which Newton-Raphson comes from speeds the other way round than they begin: short searches of many
// parts do not look so far.
std::vector<Solution> state_backwards(Analysis& driven, const SolveOptions& options) {
  SolveOptions backwards = options;
  backwards.start.clear();
  backwards.friction = backwards.details = backwards.explain = false;
  backwards.nearest = true;
  for (const CoordinateSolution& c : driven.summary().coordinates)
    if (const std::optional<FoundNumber> number = found_number(c); number && c.speed && !c.dependent)
      backwards.start.emplace_back(number->name, -number->value);
  try {
    if (Solution found = driven.solve(backwards); found.status == Status::converged)
      return {std::move(found)};
  } catch (const SceneError&) { // laws that give no number somewhere
  }
  return {};
}

// Those of these states that go with the parts.
std::vector<StateOnFriction> that_go(const Mechanism& mechanism, const FrictionParts& parts,
                                     const std::vector<Solution>& states, const SolveOptions& options) {
  SolveOptions from = options;
  from.nearest = true;
  std::vector<StateOnFriction> out;
  for (const Solution& there : states) {
    if (is_cancelled(options.cancel)) break;
    from.start = start_at(there);
    auto state = solve_with_parts(mechanism, parts, from);
    if (state && state->goes) out.push_back(std::move(*state));
  }
  return out;
}

} // namespace

bool is_among(const Solution& state, const std::vector<Solution>& states) {
  return std::ranges::any_of(states, [&](const Solution& other) {
    return scaled_distance(state.coordinates, other.coordinates) < tolerance::same_state;
  });
}

std::vector<StateOnFriction> find_states_with(const Mechanism& mechanism, const FrictionParts& parts,
                                              const SolveOptions& options) {
  for (Analysis& driven : driven_ways(mechanism, parts))
    if (const std::vector<Solution> found = states_of(driven, options); !found.empty())
      return that_go(mechanism, parts, found, options);
  return {};
}

std::optional<StateOnFriction> search_state(const Mechanism& mechanism, const std::vector<FrictionParts>& all,
                                            const SolveOptions& options) {
  struct Search {
    const FrictionParts* parts;
    Analysis driven;
  };
  std::vector<Search> searches;
  for (const FrictionParts& parts : all)
    for (Analysis& driven : driven_ways(mechanism, parts))
      searches.push_back({&parts, std::move(driven)});
  const double most = options.search * std::min(1., all_searches / static_cast<double>(searches.size()));
  std::optional<StateOnFriction> unstable;
  for (const double time : {0., short_search * most, most}) // most states are found soon
    for (Search& search : searches) {
      if (is_cancelled(options.cancel)) break;
      SolveOptions each = options;
      each.search_time = time;
      const std::vector<Solution> states =
          time > 0 ? states_of(search.driven, each) : state_backwards(search.driven, options);
      for (StateOnFriction& state : that_go(mechanism, *search.parts, states, options)) {
        if (state.solution.stable != false) return std::move(state);
        if (!unstable) unstable = std::move(state);
      }
    }
  return unstable;
}

} // namespace flyball
