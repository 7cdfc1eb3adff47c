// Where ways along places that friction holds end (placed_ways.hpp), of everything that is told, either way.
#pragma once

#include "engine/study/placed_ways.hpp"

#include <array>

namespace flyball {

class PlacedEnds {
 public:
  using Ends = std::array<PlacedWays::End, 2>; // downwards, upwards

  PlacedEnds(PlacedWays& ways, std::size_t outputs) : ways_(ways), ends_(outputs) {}

  // The ends of each joint's way, also from each end of the others', and where each is about to slip: what is
  // an extremum from one side may be passed from another. Where these are too many, more of them roughly.
  void explore(const std::vector<bool>& is_joint);
  // Of each output from the best place that is known.
  void finish();

  const Ends& operator[](Eigen::Index output) const { return ends_[static_cast<std::size_t>(output)]; }
  bool is_left(Eigen::Index output) const;
  bool lost() const { return lost_; }
  bool all_explored() const { return all_; }

 private:
  Eigen::Index count() const { return static_cast<Eigen::Index>(ends_.size()); }
  bool all_within(std::size_t places, std::size_t ends, PlacedWays::Care care,
                  const std::vector<bool>& is_joint);
  void climb(Eigen::Index output, std::size_t side, std::size_t from, PlacedWays::Care care);
  void take_turn(std::size_t other);

  PlacedWays& ways_;
  std::vector<Ends> ends_;
  std::vector<std::size_t> starts_{0};
  std::size_t explored_ = 0; // of these
  bool all_ = true;
  bool lost_ = false; // the last climb
};

bool is_unbounded(PlacedWays::End end);

} // namespace flyball
