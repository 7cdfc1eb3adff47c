// Steady states over a box of shares, of what each joint with friction gives of its limit: by what was found
// on the ways to its corners, along its edges and up to where an output is largest.
#pragma once

#include "engine/study/steady_map.hpp"

#include <atomic>
#include <deque>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

class ShareBox {
 public:
  struct Place {
    SteadyMap::State state;
    Eigen::MatrixXd rates; // of the outputs with the shares
  };

  // The outputs by names as of find_wanted().
  ShareBox(const Mechanism& mechanism, std::span<const FreeNumber> shares, std::vector<std::string> outputs,
           const std::atomic<bool>* cancel);

  // False where there is no state to begin with, or nothing has a rate there. As of SolveOptions::start.
  bool begin(const std::vector<std::pair<std::string, double>>& start);

  const Place& first() const { return places_.front(); }
  // Whether the balance folds on a way that was gone, or between two that lead to other states.
  bool lost() const { return lost_; }
  bool jumps(Eigen::Index output) const { return map_.jumps(static_cast<std::size_t>(output)); }
  std::string unit(Eigen::Index output) const { return map_.unit(static_cast<std::size_t>(output)); }
  double reach() const; // what lengths are measured by

  // Of all outputs at a place: as a solve estimates it, not numbers where it does not.
  Eigen::VectorXd errors(const Place& place);

  // From the first place to the corner to which its rates point; of one share to both ends.
  void go_to_corner(Eigen::Index output, double sense);
  // To one share, of a box of one. Whether it is there.
  bool go_to(double share);
  // To all corners, along all edges and to the middles of all faces, of not too many shares: whether the
  // balance folds between.
  void look_around();

  // The place beyond which no rate of the output, times `sense`, leads up. Of one share the highest on the
  // ways to its ends, along which the output may go up and down; of several from the best that is found
  // beside a corner or the middle of a face. `left` is what further sweeps would add, estimated.
  Place climb(Eigen::Index output, double sense, double& left);

 private:
  // Places along a straight way, from its begin on, and whether they reach its end.
  struct Way {
    Eigen::VectorXd from, to;
    std::vector<Place> places;
    bool there = false;
  };

  const Way& go(const Place& from, const Eigen::VectorXd& p);
  void add(const Place& place);
  bool differ(const Place& a, const Place& b) const;
  Place best_known(Eigen::Index output, double sense) const;
  Place highest_along(Eigen::Index output, double sense);
  bool sweep(Eigen::Index output, double sense, Place& at);
  bool climb_along(Eigen::Index output, double sense, Eigen::Index j, Place& at);
  Place crest(Eigen::Index output, Eigen::Index j, const Place& low, const Place& high);

  Eigen::Index outputs_;
  SteadyMap map_;
  std::vector<Place> places_;
  std::vector<Place> climb_starts_; // corners and middles of faces
  std::deque<Way> ways_;            // which stay where they are
  bool lost_ = false;
};

} // namespace flyball
