#include "engine/report/friction_search.hpp"
#include "engine/report/friction_state.hpp"

#include <algorithm>

namespace flyball {

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
