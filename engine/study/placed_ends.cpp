#include "engine/study/placed_ends.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Eigen::Index;

constexpr std::size_t most_places = 3000, most_ends = 120; // that are explored
constexpr double same_end = 1e-3;                          // rad, reaches or shares
constexpr double beside_end = 0.1; // of where joints are about to slip, all of which are ends

} // namespace

bool is_unbounded(PlacedWays::End end) {
  return end == PlacedWays::End::round || end == PlacedWays::End::far;
}

void PlacedEnds::explore(const std::vector<bool>& is_joint) {
  all_ = all_within(most_places, most_ends, PlacedWays::Care::whole, is_joint);
  if (all_ || lost_) return;
  all_within(2 * most_places, 2 * most_ends, PlacedWays::Care::rough, is_joint);
  lost_ = false; // beside what is known
}

bool PlacedEnds::all_within(std::size_t places, std::size_t ends, PlacedWays::Care care,
                            const std::vector<bool>& is_joint) {
  const std::size_t before = ways_.last_place();
  for (; explored_ < std::min(starts_.size(), ends) && ways_.last_place() - before < places; ++explored_)
    for (Index i = 0; i < ways_.objectives(); ++i)
      if (i >= count() || is_joint[static_cast<std::size_t>(i)])
        for (const std::size_t side : {0u, 1u}) {
          climb(i, side, starts_[explored_], care);
          if (lost_) return false;
        }
  return explored_ == starts_.size();
}

void PlacedEnds::finish() {
  for (Index i = 0; i < count(); ++i)
    for (const std::size_t side : {0u, 1u}) {
      if (lost_) return;
      climb(i, side, ways_.best_place(i, side == 0 ? -1 : 1), PlacedWays::Care::whole);
    }
}

bool PlacedEnds::is_left(Index output) const {
  return std::ranges::count((*this)[output], PlacedWays::End::left) > 0;
}

void PlacedEnds::climb(Index output, std::size_t side, std::size_t from, PlacedWays::Care care) {
  if (!ways_.has_rates(output)) return;
  if (output < count() && is_unbounded((*this)[output][side])) return;
  const PlacedWays::End end = ways_.climb(output, side == 0 ? -1 : 1, from, care);
  lost_ = end == PlacedWays::End::lost;
  if (output < count()) ends_[static_cast<std::size_t>(output)][side] = end;
  for (const std::size_t start : starts_) {
    const PlacedWays::Beside beside = ways_.compare_last(start, output < count() ? same_end : beside_end);
    if (beside == PlacedWays::Beside::turned) take_turn(start);
    if (beside != PlacedWays::Beside::elsewhere) return;
  }
  starts_.push_back(ways_.last_place());
}

// What the last place has otherwise than one that differs by whole turns goes on either way.
void PlacedEnds::take_turn(std::size_t other) {
  for (Index i = 0; i < count(); ++i)
    if (ways_.has_rates(i) && ways_.changes_to_last(other, i))
      ends_[static_cast<std::size_t>(i)].fill(ways_.unit(i) == "rad"   ? PlacedWays::End::round
                                              : ways_.is_coordinate(i) ? PlacedWays::End::far
                                                                       : PlacedWays::End::left);
}

} // namespace flyball
