#include "engine/report/friction_state.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/report/friction_search.hpp"
#include "engine/report/messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace flyball {
namespace {

using Part = FrictionPart;

constexpr double balance_search = 0.02; // s, for what rests in balance beside what is held: see SolveOptions
constexpr std::size_t most_tried = 3;   // joints that may slip: each forwards, backwards or not at all
constexpr int most_attempts = 2000;     // where more may: random clutches and brakes, six, took up to 1400

std::size_t place(int i) {
  return static_cast<std::size_t>(i);
}

// Joints by coordinate with friction.
std::vector<std::size_t> that_may_slip(const Mechanism& mechanism,
                                       const std::vector<CoordinateReference>& frictions) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < frictions.size(); ++i)
    if (may_slip(mechanism, frictions[i])) out.push_back(i);
  return out;
}

bool any_slips(const FrictionParts& parts) {
  return std::ranges::any_of(parts, is_slipping);
}

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

// Of what a torque turns, itself or through gears, the way of the speed with which its search begins.
Part part_at_start(const Mechanism& mechanism, CoordinateReference friction) {
  for (const GearedCoordinate& geared : gear_train(mechanism, friction))
    if (const std::optional<Drive>& drive = coordinate_of(mechanism, geared.at).drive; drive && drive->torque)
      return drive->speed * geared.ratio > 0 ? Part::slips_forwards : Part::slips_backwards;
  return Part::none;
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

// With rates that are found by the torques or, where that leads to no state, of some that the drives give:
// at first by Newton-Raphson alone, as one of the two has none. Of more than six that close loops the
// torques give the rates of all but the first six. One that goes before others. `loose`: see
// attempt_parts(). `attempts`: counts those made, if given.
std::optional<StateOnFriction> let_slip(const Mechanism& mechanism,
                                        const std::vector<CoordinateReference>& frictions,
                                        const FrictionParts& parts, const SolveOptions& options,
                                        bool loose = false, int* attempts = nullptr) {
  const std::vector<std::vector<bool>> ways = implied_ways(mechanism, frictions, parts);
  std::optional<StateOnFriction> first;
  for (const bool newton_only : {true, false}) {
    if (newton_only && ways.size() == 1) continue;
    if (!newton_only && options.newton_only && ways.size() > 1) break; // that has been
    SolveOptions now = options;
    now.newton_only = newton_only || options.newton_only;
    for (const std::vector<bool>& implied : ways) {
      if (is_cancelled(options.cancel)) return first;
      auto state = attempt_parts(mechanism, frictions, parts, now, nullptr, implied, loose);
      if (attempts) ++*attempts;
      if (state && (state->goes || !first)) first = std::move(state);
      if (first && first->goes) return first;
    }
    if (first) return first;
  }
  return std::nullopt;
}

// Of more joints than all ways are tried of: from the parts with which they begin the part of one joint is
// changed at a time, of one whose friction would have to give more than its limit, that slips against the way
// it is taken to or goes on without a part, until all go (principal pivoting: Murty, Opsearch 11, 1974).
// Those with the fewest violated conditions are changed first, and no parts are tried twice, so that it
// cannot cycle. By Newton-Raphson alone.
class PartsSearch {
 public:
  PartsSearch(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
              const SolveOptions& options)
      : mechanism_(mechanism), frictions_(frictions), tried_(that_may_slip(mechanism, frictions)),
        options_(options) {
    options_.newton_only = true;
    options_.search = 0;
  }

  // Until `accept` takes parts that go.
  template <class Accept>
  void find(const Accept& accept) {
    begin();
    for (int attempts = 0; attempts < most_attempts && !queue_.empty() && !is_cancelled(options_.cancel);) {
      const int wrong = queue_.begin()->first;
      const FrictionParts parts = std::move(queue_.begin()->second);
      queue_.erase(queue_.begin());
      std::optional<StateOnFriction> state =
          let_slip(mechanism_, frictions_, parts, options_, true, &attempts);
      if (!state)
        change_any(parts, wrong + static_cast<int>(tried_.size()));
      else if (!state->goes)
        change_wrong(*state);
      else if (accept(parts))
        return;
    }
  }

 private:
  // What torques turn slips as that begins; of the rest it holds what loops do not tie to that.
  void begin() {
    FrictionParts parts(frictions_.size(), Part::none);
    for (const std::size_t i : find_holding(mechanism_, {}, options_.cancel, false).independent)
      parts[i] = Part::holds;
    for (const std::size_t i : tried_)
      if (const Part part = part_at_start(mechanism_, frictions_[i]); part != Part::none) parts[i] = part;
    add(std::move(parts), 0);
  }

  void add(FrictionParts parts, int wrong) {
    const bool plays = std::ranges::count(parts, Part::none) < std::ssize(parts); // else it is as without it
    if (plays && seen_.insert(parts).second) queue_.emplace(wrong, std::move(parts));
  }

  void add(FrictionParts parts, std::size_t i, Part part, int wrong) {
    parts[i] = part;
    add(std::move(parts), wrong);
  }

  void change_any(const FrictionParts& parts, int wrong) {
    for (const std::size_t i : tried_)
      for (const Part part : {Part::holds, Part::slips_forwards, Part::slips_backwards, Part::none})
        add(parts, i, part, wrong);
  }

  void change_wrong(const StateOnFriction& state) {
    std::vector<std::size_t> wrong;
    for (const std::size_t i : tried_)
      if (!(state.margins[i] > 0)) wrong.push_back(i);
    const auto count = static_cast<int>(wrong.size());
    for (const std::size_t i : wrong) {
      if (is_slipping(state.parts[i])) {
        add(state.parts, i, Part::holds, count);
        add(state.parts, i, Part::none, count);
        continue;
      }
      const std::optional<double> way = way_beyond(state, i);
      if (!way || *way > 0) add(state.parts, i, Part::slips_forwards, count);
      if (!way || *way < 0) add(state.parts, i, Part::slips_backwards, count);
      if (state.parts[i] == Part::none) add(state.parts, i, Part::holds, count);
    }
    for (const std::size_t i : tried_) // which stands with others, and may bear a share of what they hold
      if (state.parts[i] == Part::none && state.margins[i] > 0)
        for (const Part part : {Part::holds, Part::slips_forwards, Part::slips_backwards})
          add(state.parts, i, part, count);
  }

  // Which way one would go that holds too much or goes on: its sign. Nothing where that is open.
  std::optional<double> way_beyond(const StateOnFriction& state, std::size_t i) const {
    const auto is_it = [&](const auto& x) {
      return x.joint == joint_of(mechanism_, frictions_[i]).name && x.index == frictions_[i].coordinate;
    };
    if (state.parts[i] == Part::none) return std::ranges::find_if(state.solution.coordinates, is_it)->speed;
    const auto force = std::ranges::find_if(state.solution.frictions, is_it);
    return force->value ? std::optional(-*force->value) : std::nullopt;
  }

  const Mechanism& mechanism_;
  const std::vector<CoordinateReference>& frictions_;
  std::vector<std::size_t> tried_;
  SolveOptions options_;
  std::multimap<int, FrictionParts> queue_; // by how many conditions those before violated
  std::set<FrictionParts> seen_;
};

// What all that has a part at first holds, then all ways of few joints, or of more that in which they begin.
std::vector<FrictionParts> parts_to_try(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  std::vector<FrictionParts> all{FrictionParts(frictions.size(), Part::none)};
  std::vector<std::size_t> tried = that_may_slip(mechanism, frictions);
  if (tried.size() > most_tried) { // all ways would be too many: that in which they begin to slip, if none
                                   // closes a loop, whose rates take seconds to find or not
    FrictionParts slipping(frictions.size(), Part::none);
    for (const std::size_t i : tried)
      slipping[i] = part_at_start(mechanism, frictions[i]);
    if (std::ranges::none_of(tried,
                             [&](std::size_t i) { return closes_a_loop(mechanism, frictions[i].joint); }))
      all.push_back(std::move(slipping));
    tried.clear();
  }
  for (const std::size_t i : tried) {
    std::vector<FrictionParts> longer;
    for (const FrictionParts& parts : all)
      for (const Part part : {Part::holds, Part::none, Part::slips_forwards, Part::slips_backwards}) {
        longer.push_back(parts);
        longer.back()[i] = part;
      }
    all = std::move(longer);
  }
  FrictionParts held(frictions.size(), Part::none);
  for (const std::size_t i : find_holding(mechanism, {}, cancel, false).independent)
    held[i] = Part::holds;
  std::erase_if(all, [&](const FrictionParts& parts) {
    return parts == held || std::ranges::count(parts, Part::none) == std::ssize(parts);
  });
  std::ranges::stable_sort(all, std::greater(), [](const FrictionParts& parts) {
    return std::pair(std::ranges::count(parts, Part::holds), std::ranges::count(parts, Part::none));
  });
  all.insert(all.begin(), held);
  return all;
}

} // namespace

std::vector<FrictionParts> friction_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
  std::vector<FrictionParts> all = parts_to_try(mechanism, cancel);
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  if (that_may_slip(mechanism, frictions).size() <= most_tried) return all;
  SolveOptions options;
  options.cancel = cancel;
  PartsSearch(mechanism, frictions, options).find([&](const FrictionParts& parts) {
    if (std::ranges::find(all, parts) == all.end()) all.push_back(parts);
    return true;
  });
  return all;
}

FrictionParts parts_of(const Mechanism& mechanism, std::span<const FrictionForce> frictions) {
  const std::vector<CoordinateReference> all = find_frictions(mechanism);
  FrictionParts out(all.size(), Part::none);
  for (const FrictionForce& force : frictions) {
    const auto at = std::ranges::find(all, find_coordinate(mechanism, coordinate_label(force)));
    if (at == all.end()) continue;
    out[place(static_cast<int>(at - all.begin()))] = !force.slips                 ? Part::holds
                                                     : std::signbit(*force.value) ? Part::slips_forwards
                                                                                  : Part::slips_backwards;
  }
  return out;
}

bool holds_more(const FrictionParts& here, const FrictionParts& there) {
  return here != there && std::ranges::equal(here, there, [](Part a, Part b) {
           return a == b || (a == Part::holds && b == Part::none);
         });
}

std::optional<StateOnFriction> solve_with_parts(const Mechanism& mechanism, const FrictionParts& parts,
                                                const SolveOptions& options, double slip_search) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  SolveOptions inner = options;
  std::erase_if(inner.start, [&](const auto& named) { // these stand as drawn
    const auto found = std::ranges::find(frictions, find_coordinate(mechanism, named.first));
    return found != frictions.end() &&
           parts[place(static_cast<int>(found - frictions.begin()))] == Part::holds;
  });
  if (any_slips(parts)) {
    inner.search = slip_search;
    auto state = let_slip(mechanism, frictions, parts, inner);
    if (state) add_message(*state, slipping_text(*state));
    return state;
  }
  const Holding holding = find_holding(mechanism, inner.start, inner.cancel, false);
  const bool all_hold =
      std::ranges::all_of(holding.independent, [&](std::size_t i) { return parts[i] == Part::holds; });
  if (all_hold) return hold_as_drawn(mechanism, frictions, parts, holding, inner);
  inner.search = inner.newton_only || inner.nearest ? 0 : balance_search;
  auto state = attempt_parts(mechanism, frictions, parts, inner);
  if (state)
    add_message(*state, "Friction holds " + names_of(state->solution.frictions, false) + " as drawn.");
  return state;
}

namespace {

// Where Newton-Raphson comes to no state that goes with the parts it has: of all that a search finds one that
// is not unstable, else the first.
std::optional<StateOnFriction> search_parts(const Mechanism& mechanism, const std::vector<FrictionParts>& all,
                                            const SolveOptions& options) {
  SolveOptions search = options;
  search.search_time = options.search; // of each
  std::optional<StateOnFriction> unstable;
  for (const FrictionParts& parts : all) {
    if (!(options.search > 0) || is_cancelled(options.cancel)) break;
    for (StateOnFriction& state : find_states_with(mechanism, parts, search)) {
      if (state.solution.stable != false) return std::move(state);
      if (!unstable) unstable = std::move(state);
    }
  }
  return unstable;
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
  std::vector<FrictionParts> all = parts_to_try(mechanism, options.cancel);
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
  std::ranges::stable_sort(all, std::greater(), as_it_begins); // that goes first
  // What slips at first by Newton-Raphson alone, which takes a fraction of the time where there is no such
  // state, then by all that solving knows; by a search where nothing else is found. What slips as it begins
  // is looked for by all that solving knows before it is said to stand.
  struct Effort {
    bool newton_only;
    double slip_search;
  };
  const std::array efforts{Effort{true, 0}, Effort{false, 0}, Effort{false, balance_search}};
  const std::size_t first = options.newton_only ? 1 : 0;
  for (std::size_t e = first; e < efforts.size() && !unstable; ++e) {
    const auto [newton_only, slip_search] = efforts[e];
    if (slip_search > options.search) break;
    SolveOptions now = options;
    now.newton_only = now.newton_only || newton_only;
    for (const FrictionParts& parts : all) {
      const bool slips = any_slips(parts);
      if (e > first && !slips) continue;
      auto state = solve_with_parts(mechanism, parts, slips ? now : options, slip_search);
      if (!state || !state->goes) continue;
      if (!slips && newton_only)
        for (const FrictionParts& turning : all) {
          if (as_it_begins(turning) == 0) break;
          auto turns = solve_with_parts(mechanism, turning, options, 0);
          if (turns && turns->goes && turns->solution.stable != false) return turns;
        }
      if (!slips || state->solution.stable != false) return state;
      if (!newton_only && !unstable) unstable = std::move(state);
    }
  }
  if (unstable) return unstable;
  if (that_may_slip(mechanism, frictions).size() <= most_tried)
    return options.newton_only ? std::nullopt : search_parts(mechanism, all, options);
  std::optional<StateOnFriction> found;
  PartsSearch(mechanism, frictions, options).find([&](const FrictionParts& parts) {
    SolveOptions inner = options;
    inner.search = 0;
    auto state = let_slip(mechanism, frictions, parts, inner, true);
    if (!state || !state->goes) return false;
    add_message(*state, slipping_text(*state));
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

bool tries_all_parts(const Mechanism& mechanism) {
  return that_may_slip(mechanism, find_frictions(mechanism)).size() <= most_tried;
}

std::vector<std::string> slipping_coordinates(const Mechanism& mechanism) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  std::vector<FrictionParts> all = parts_to_try(mechanism, nullptr);
  if (const auto tried = that_may_slip(mechanism, frictions); tried.size() > most_tried)
    for (const std::size_t i : tried) { // whatever the others do
      all.emplace_back(frictions.size(), Part::none);
      all.back()[i] = Part::slips_forwards;
    }
  std::vector<std::string> out;
  for (const FrictionParts& parts : all) {
    if (!any_slips(parts) || std::ranges::count(parts, Part::slips_backwards) > 0) continue;
    try {
      for (const CoordinateSolution& c :
           Analysis(driven_by_parts(mechanism, frictions, parts)).summary().coordinates)
        if (c.speed && std::ranges::find(out, coordinate_label(c)) == out.end())
          out.push_back(coordinate_label(c));
    } catch (const SceneError&) { // drives that close a loop, say
    }
  }
  return out;
}

} // namespace flyball
