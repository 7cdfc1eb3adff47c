#include "engine/report/solve_with_parts.hpp"

#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/report/messages.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Part = FrictionPart;

constexpr double balance_search = 0.02; // s, for what rests in balance beside what is held: see SolveOptions

std::string names_of(const std::vector<FrictionForce>& frictions, bool slipping) {
  std::vector<std::string> names;
  for (const FrictionForce& force : frictions)
    if (force.slips == slipping) names.push_back(coordinate_label(force));
  return word_list(std::vector<std::string_view>(names.begin(), names.end()), "and");
}

// What is said of a state, in the place of "Converged.".
void add_message(StateOnFriction& state, std::string text) {
  constexpr std::string_view plain = "Converged.";
  std::string& message = state.solution.message;
  const std::string rest = message.starts_with(plain) ? message.substr(plain.size()) : " " + message;
  message = std::move(text) + rest;
}

// All that there are by find_holding().
std::optional<StateOnFriction> hold_as_drawn(const Mechanism& mechanism,
                                             const std::vector<CoordinateReference>& frictions,
                                             const FrictionParts& parts, const Holding& holding,
                                             const SolveOptions& options) {
  if (!holding.takes) return std::nullopt;
  auto state = attempt_parts(mechanism, frictions, parts, options, &holding);
  if (state)
    add_message(*state, "Friction holds " + names_of(state->solution.frictions, false) +
                            " as drawn: that takes " + rounded_text(100 * *holding.takes, 3) +
                            " % of what it can give.");
  return state;
}

// Of what is found by let_slip().
std::string slipping_text(const StateOnFriction& state) {
  const std::vector<FrictionForce>& forces = state.solution.frictions; // of what has a part, in its order
  bool shared = false; // what is taken to slip stands with others
  auto force = forces.begin();
  for (const Part part : state.parts) {
    if (part == Part::none) continue;
    shared = shared || (is_slipping(part) && !force->slips);
    ++force;
  }
  const std::string holding = names_of(forces, false);
  const std::string end = shared ? ": how they share what they hold is open, this is one way." : ".";
  const auto slipping = std::ranges::count(forces, true, &FrictionForce::slips);
  if (slipping == 0) return "Friction holds " + holding + (shared ? end : " as drawn.");
  return names_of(forces, true) +
         (slipping > 1 ? " slip at constant rates, against which friction gives its limits"
                       : " slips at a constant rate, against which friction gives its limit") +
         (holding.empty() ? "." : "; it holds " + holding + end);
}

} // namespace

std::optional<StateOnFriction> solve_with_parts(const Mechanism& mechanism, const FrictionParts& parts,
                                                const SolveOptions& options) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  SolveOptions inner = options;
  std::erase_if(inner.start, [&](const auto& named) { // these stand as drawn
    const auto found = std::ranges::find(frictions, find_coordinate(mechanism, named.first));
    return found != frictions.end() &&
           parts[static_cast<std::size_t>(found - frictions.begin())] == Part::holds;
  });
  if (std::ranges::any_of(parts, is_slipping)) {
    inner.search = 0;
    auto state = let_slip(mechanism, frictions, parts, inner);
    if (state) tell_what_slips(*state);
    return state;
  }
  const Holding holding = find_holding(mechanism, inner.start, inner.cancel, false);
  const bool all_hold =
      std::ranges::all_of(holding.independent, [&](std::size_t i) { return parts[i] == Part::holds; });
  if (all_hold) return hold_as_drawn(mechanism, frictions, parts, holding, inner);
  inner.search = inner.newton_only || inner.nearest ? 0 : std::min(options.search, balance_search);
  auto state = attempt_parts(mechanism, frictions, parts, inner);
  if (state)
    add_message(*state, "Friction holds " + names_of(state->solution.frictions, false) + " as drawn.");
  return state;
}

void tell_what_slips(StateOnFriction& state) {
  add_message(state, slipping_text(state));
}

} // namespace flyball
