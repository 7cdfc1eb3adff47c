#include "engine/report/friction_ways.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/friction_implied.hpp"
#include "engine/report/turns_in_place.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace flyball {
namespace {

using Part = FrictionPart;

constexpr std::size_t most_tried = 3; // joints that may slip: each forwards, backwards or not at all
constexpr int most_attempts = 2000;   // where more may: random clutches and brakes, six, took up to 1400

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
  void find(const std::function<bool(const FrictionParts&)>& accept) {
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

} // namespace

bool tries_all_parts(const Mechanism& mechanism) {
  return that_may_slip(mechanism, find_frictions(mechanism)).size() <= most_tried;
}

std::vector<FrictionParts> first_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
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
  const bool in_place = turns_in_place(mechanism);
  const auto rests_nowhere = [&](const FrictionParts& parts) {
    std::vector<CoordinateReference> standing;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i] == Part::holds) standing.push_back(frictions[i]);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i] == Part::none && !is_tied(mechanism, standing, frictions[i])) return true;
    return false;
  };
  std::erase_if(all, [&](const FrictionParts& parts) {
    return parts == held || (in_place && rests_nowhere(parts)) ||
           std::ranges::count(parts, Part::none) == std::ssize(parts);
  });
  std::ranges::stable_sort(all, std::greater(), [](const FrictionParts& parts) {
    return std::pair(std::ranges::count(parts, Part::holds), std::ranges::count(parts, Part::none));
  });
  all.insert(all.begin(), held);
  return all;
}

void search_by_single_joints(const Mechanism& mechanism, const SolveOptions& options,
                             const std::function<bool(const FrictionParts&)>& accept) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  PartsSearch(mechanism, frictions, options).find(accept);
}

std::vector<FrictionParts> friction_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel) {
  std::vector<FrictionParts> all = first_parts(mechanism, cancel);
  if (tries_all_parts(mechanism)) return all;
  SolveOptions options;
  options.cancel = cancel;
  search_by_single_joints(mechanism, options, [&](const FrictionParts& parts) {
    if (std::ranges::find(all, parts) == all.end()) all.push_back(parts);
    return true;
  });
  return all;
}

std::vector<std::string> slipping_coordinates(const Mechanism& mechanism) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  std::vector<FrictionParts> all = first_parts(mechanism, nullptr);
  if (const auto tried = that_may_slip(mechanism, frictions); tried.size() > most_tried)
    for (const std::size_t i : tried) { // whatever the others do
      all.emplace_back(frictions.size(), Part::none);
      all.back()[i] = Part::slips_forwards;
    }
  std::vector<std::string> out;
  for (const FrictionParts& parts : all) {
    if (std::ranges::none_of(parts, is_slipping) || std::ranges::count(parts, Part::slips_backwards) > 0)
      continue;
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
