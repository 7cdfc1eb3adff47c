// The response to one parameter at each place of a grid of others: branches, folds and crossings over a map.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "engine/study/hopf_point.hpp"
#include "engine/study/sweep.hpp"

namespace flyball {

struct GridBranches {
  std::vector<double> parameters; // by variation
  // As of follow_branches; where no mechanism can be made of the numbers, `infeasible` and the reason.
  ResponseDiagram diagram;
  // The bands of dry friction at the points of each branch; empty without.
  std::vector<std::vector<RibbonPoint>> ribbons;
  HopfPoints hunting; // of each special point
};

// Follows branches at places of a grid, in any order: each is made by itself. For any number of threads.
class GridFollower {
 public:
  // Along the number at `address` between `from` and `to`, over the grid of the others. Throws SceneError for
  // an address that the mechanism does not take, or that is there twice.
  GridFollower(const Mechanism& mechanism, std::span<const Variation> over, std::string address, double from,
               double to, const BranchOptions& options);

  // Throws nothing for what is wrong with the place.
  GridBranches follow(std::size_t i) const;

 private:
  Mechanism mechanism_;
  std::vector<Variation> over_;
  std::string address_;
  double from_, to_;
  BranchOptions options_;
};

} // namespace flyball
