#include "engine/report/friction_state.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/report/friction_search.hpp"
#include "engine/report/friction_ways.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/solve_with_parts.hpp"

#include <algorithm>
#include <functional>

namespace flyball {
namespace {

using Part = FrictionPart;

constexpr double balance_searches = 0.06; // s, see SolveOptions: of all ways in which nothing slips

bool any_slips(const FrictionParts& parts) {
  return std::ranges::any_of(parts, is_slipping);
}

} // namespace

std::optional<StateOnFriction> find_friction_state(const Mechanism& mechanism, const SolveOptions& options) {
  // Joints that it holds stand as drawn.
  for (const auto& [name, value] : options.start) {
    const CoordinateReference named = find_coordinate(mechanism, name);
    if (named.joint < 0) continue;
    const Coordinate& c = coordinate_of(mechanism, named);
    if (c.friction && c.drawn != value && !is_at_given_speed(mechanism, named)) return std::nullopt;
  }
  std::optional<StateOnFriction> unstable;
  std::vector<FrictionParts> all = first_parts(mechanism, options.cancel);
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  std::vector<Part> at_start;
  for (const CoordinateReference& at : frictions)
    at_start.push_back(part_at_start(mechanism, at));
  const auto as_it_begins = [&](const FrictionParts& parts) {
    int count = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      count += is_slipping(parts[i]) && parts[i] == at_start[i];
    return count;
  };
  // What slips at first by Newton-Raphson alone, which takes a fraction of the time where there is no such
  // state, then by all that solving knows; by a search where nothing else is found. What slips as it begins
  // is looked for by all that solving knows before it is said to stand.
  const FrictionParts as_drawn = all.front();
  std::ranges::stable_sort(all, std::greater(), as_it_begins); // that goes first
  const auto standing =
      std::ranges::count_if(all, [](const FrictionParts& parts) { return !any_slips(parts); });
  SolveOptions beside = options; // what is held, of which there are several ways
  beside.search = std::min(options.search, balance_searches / static_cast<double>(standing));
  for (const bool newton_only : {true, false}) {
    if (newton_only && options.newton_only) continue; // as that is then
    SolveOptions slipping = options;
    slipping.newton_only = newton_only || options.newton_only;
    for (const FrictionParts& parts : all) {
      const bool slips = any_slips(parts);
      if (!newton_only && !options.newton_only && !slips) continue; // looked for before
      auto state = solve_with_parts(mechanism, parts,
                                    slips               ? slipping
                                    : parts == as_drawn ? options
                                                        : beside);
      if (!state || !state->goes) continue;
      if (!slips && newton_only)
        for (const FrictionParts& turning : all) {
          if (as_it_begins(turning) == 0) break;
          auto turns = solve_with_parts(mechanism, turning, options);
          if (turns && turns->goes && turns->solution.stable != false) return turns;
        }
      if (!slips || state->solution.stable != false) return state;
      if (!newton_only && !unstable) unstable = std::move(state);
    }
  }
  if (unstable) return unstable;
  if (tries_all_parts(mechanism))
    return options.newton_only || !(options.search > 0) ? std::nullopt
                                                        : search_state(mechanism, all, options);
  std::optional<StateOnFriction> found;
  search_by_single_joints(mechanism, options, [&](const FrictionParts& parts) {
    SolveOptions inner = options;
    inner.search = 0;
    auto state = let_slip(mechanism, frictions, parts, inner, true);
    if (!state || !state->goes) return false;
    tell_what_slips(*state);
    if (state->solution.stable != false)
      found = std::move(state);
    else if (!unstable)
      unstable = std::move(state);
    return found.has_value();
  });
  return found ? std::move(found) : std::move(unstable);
}

std::string asked_of_friction(const Mechanism& mechanism, std::string_view asked,
                              const std::atomic<bool>* cancel) {
  if (!has_friction(mechanism)) return {};
  SolveOptions options;
  options.details = options.explain = false;
  options.cancel = cancel;
  try {
    const Solution steady = Analysis(mechanism).solve(options);
    if (steady.status == Status::converged && !steady.frictions.empty())
      return rests_on_friction(steady, asked);
  } catch (const SceneError&) { // no mechanism can be made of the numbers, say
  }
  return {};
}

std::vector<Solution> find_friction_states(const Mechanism& mechanism, const SolveOptions& options) {
  const std::vector<FrictionParts> all = friction_parts(mechanism, options.cancel);
  SolveOptions plain = options;
  plain.start.clear();
  plain.search_time /= static_cast<double>(all.size());
  std::vector<Solution> out;
  std::vector<FrictionParts> found;
  const auto add = [&](StateOnFriction state) {
    if (!is_among(state.solution, out)) out.push_back(std::move(state.solution));
  };
  for (const FrictionParts& parts : all) {
    if (std::ranges::any_of(found, [&](const FrictionParts& other) { return holds_more(other, parts); }))
      continue; // in the band of that
    const std::size_t before = out.size();
    if (auto state = solve_with_parts(mechanism, parts, plain); state && state->goes) add(std::move(*state));
    for (StateOnFriction& state : find_states_with(mechanism, parts, plain))
      add(std::move(state));
    if (out.size() > before) found.push_back(parts);
  }
  if (!out.empty() || tries_all_parts(mechanism)) return out;
  if (auto state = find_friction_state(mechanism, plain)) out.push_back(std::move(state->solution));
  return out;
}

} // namespace flyball
