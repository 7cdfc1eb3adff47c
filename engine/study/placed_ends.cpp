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
  std::size_t explored = 0;
  for (; explored < std::min(starts_.size(), most_ends) && ways_.last_place() < most_places; ++explored)
    for (Index i = 0; i < ways_.objectives(); ++i)
      if (i >= count() || is_joint[static_cast<std::size_t>(i)])
        for (const std::size_t side : {0u, 1u}) {
          climb(i, side, starts_[explored]);
          if (lost_) return;
        }
  all_ = explored == starts_.size();
}

void PlacedEnds::finish() {
  for (Index i = 0; i < count(); ++i)
    for (const std::size_t side : {0u, 1u}) {
      if (lost_) return;
      climb(i, side, ways_.best_place(i, side == 0 ? -1 : 1));
    }
}

bool PlacedEnds::is_left(Index output) const {
  return std::ranges::count((*this)[output], PlacedWays::End::left) > 0;
}

void PlacedEnds::climb(Index output, std::size_t side, std::size_t from) {
  if (!ways_.has_rates(output)) return;
  if (output < count() && is_unbounded((*this)[output][side])) return;
  const PlacedWays::End end = ways_.climb(output, side == 0 ? -1 : 1, from);
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
