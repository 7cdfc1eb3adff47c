// How far two configurations are from each other, and when they are one pose.
#pragma once

#include "engine/kkt/problem.hpp"

#include <vector>

namespace flyball {

// Whether two configurations are one pose: scaled distance of each coordinate below `tolerance`, angles of
// joints without spring or stop modulo whole turns. `ignore` lists coordinates of q_R that do not count
// (neutral directions).
bool same_pose(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance,
               const std::vector<int>& ignore = {});

// The same with whole turns of every angle left out: true for a pose whose springs are wound further by whole
// turns.
bool same_but_for_turns(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                        double tolerance);

// The scaled step of q_R from one configuration to another, angles of unsprung joints the short way round.
Eigen::VectorXd scaled_difference(const Problem& problem, const Eigen::VectorXd& from,
                                  const Eigen::VectorXd& to);

// The same many times with the same numbers, which are looked at once.
class ScaledDifference {
 public:
  // `problem` must stay as it is.
  explicit ScaledDifference(const Problem& problem);
  void take(const Eigen::VectorXd& from, const Eigen::VectorXd& to, Eigen::VectorXd& out) const;

 private:
  const Problem& problem_;
  std::vector<char> without_turns_; // by link
};

// The sum of squares of scaled distances, rotations by their angles.
double squared_distance(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

} // namespace flyball
