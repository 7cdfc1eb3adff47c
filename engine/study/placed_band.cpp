#include "engine/study/placed_band.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/study/placed_ends.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

using Eigen::Index;

constexpr double most_give = 1e-3, least_give = 1e-6; // of the springs: see stand_on_springs()
constexpr std::size_t most_joints_placed = 6;

FrictionBand tell(const Mechanism& mechanism, const std::vector<std::string>& names, PlacedWays& ways,
                  const PlacedEnds& ends, bool several) {
  FrictionBand band;
  std::vector<std::string_view> round, farther, jumping, left;
  for (Index i = 0; i < static_cast<Index>(names.size()); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    if (!ways.has_rates(i)) continue;
    if (ways.jumps(i)) {
      jumping.push_back(name);
      continue;
    }
    if (ends.is_left(i)) {
      left.push_back(name);
      continue;
    }
    BandExtent extent;
    extent.name = name;
    extent.unit = ways.unit(i);
    extent.value = ways.value(i);
    const auto end = [&](std::size_t side, double sense, double& value, std::optional<bool>& stable) {
      const std::size_t place = ways.best_place(i, sense);
      const bool unbounded = is_unbounded(ends[i][side]);
      value = unbounded ? sense * std::numeric_limits<double>::infinity() : ways.best(i, sense);
      if (!unbounded) stable = ways.stable_at(mechanism, place);
    };
    end(0, -1, extent.low, extent.stable_low);
    end(1, 1, extent.high, extent.stable_high);
    if (std::ranges::count(ends[i], PlacedWays::End::far) > 0)
      farther.push_back(name);
    else if (std::ranges::count(ends[i], PlacedWays::End::round) > 0)
      round.push_back(name);
    band.extents.push_back(std::move(extent));
  }
  band.found = true;
  band.whole = false;
  band.folds = true;
  band.message = "It is the band by where the joints with friction stand";
  band.at_least = several && !ends.all_explored();
  if (several) band.message += "; each extent is an extremum nearby";
  if (band.at_least) band.message += ", and it may go farther";
  band.message += ".";
  if (!round.empty())
    band.message += " Friction holds it at any angle: " + word_list(round, "and") + " can go round.";
  if (!farther.empty())
    band.message += " Friction holds " + word_list(farther, "and") +
                    " farther than the band was followed, so that no bound is told.";
  if (!left.empty())
    band.message += " No extent is told of " + word_list(left, "and") +
                    ", which was not followed to an end: other coordinates go round, or too far.";
  if (!jumping.empty())
    band.message += " No extent is told of " + word_list(jumping, "and") + ", which jumps within the band.";
  return band;
}

} // namespace

FrictionBand find_placed_band(const Mechanism& mechanism, const Solution& state,
                              const std::vector<std::string>& names,
                              const std::vector<std::size_t>& independent, double reach,
                              const std::atomic<bool>* cancel) {
  if (independent.size() > most_joints_placed) return {};
  // Springs that give too much fold with what they hold against.
  for (double give = most_give; give > 0.9 * least_give; give /= 30) {
    const auto standing = stand_on_springs(mechanism, state, independent, reach, give);
    if (!standing || standing->joints.empty()) return {};
    PlacedWays ways(*standing, names, freely_turning(mechanism, names), reach, cancel);
    if (!ways.begin(state)) return {};
    std::vector<bool> is_joint;
    for (const std::string& name : names)
      is_joint.push_back(std::ranges::find(standing->joints, name, &StandingJoint::name) !=
                         standing->joints.end());
    PlacedEnds ends(ways, names.size());
    ends.explore(is_joint);
    ends.finish();
    if (!ends.lost()) return tell(mechanism, names, ways, ends, standing->joints.size() > 1);
  }
  return {};
}

} // namespace flyball
