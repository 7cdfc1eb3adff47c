// Where a search for all equilibria looks: its bounds, and a sequence of starts that fills them.
#pragma once

#include "engine/kkt/problem.hpp"

#include <cstdint>
#include <vector>

namespace flyball {

struct SearchRange {
  double lower = 0, upper = 0; // rad or m, as the joint labels its coordinate
  // Starts lie evenly up to here from zero, and beyond it as many in each order of magnitude; 0: evenly
  // everywhere.
  double even = 0;
};

// By coordinate in System::coordinates. Angles: one turn about zero, or about the drawn value where that lies
// outside; slides: twice the mechanism's reach around the drawn value (four times, what floats) and the
// spring's free one, or the places where its law changes its direction, as far as stops let them go. Driven
// coordinates from and to their value at the drawn phase; where a torque drives, speeds (rad/s or m/s) from
// rest to three times that at which the search for them begins; of drives that keep a momentum whatever that
// makes of it at the starts.
std::vector<SearchRange> search_ranges(const Problem& problem, const Eigen::VectorXd& drawn);

// Widens those of speeds that are found to `times` as much either way, with starts of every order of
// magnitude. False where there are none.
bool widen_speeds(const Problem& problem, double times, std::vector<SearchRange>& ranges);

// Widens the ranges of slides, and of angles with springs or stops, so that they contain `q`.
void include(const Problem& problem, const Eigen::VectorXd& q, std::vector<SearchRange>& ranges);

enum class Placement {
  within,  // whole turns that do not matter taken off
  turned,  // whole turns were taken off an angle with a spring, a stop or a gear: no longer the same state
  outside, // and left there
};

// Takes whole turns off angles so that `q` lies within the ranges.
Placement bring_within(const Problem& problem, const std::vector<SearchRange>& ranges, Eigen::VectorXd& q);

// The starts: x_i = frac(x_0 + i (sqrt 2, sqrt 3, sqrt 5, ...)), a sequence of low discrepancy (Richtmyer
// 1951; Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, 1992, section 3.1), stretched
// over the ranges. Rotations are uniform (Shoemake, Uniform random rotations, 1992).
class SearchStarts {
 public:
  // The same seed gives the same starts.
  SearchStarts(const Problem& problem, const std::vector<SearchRange>& ranges, std::uint32_t seed);

  // The next one. The loops of `q`, a configuration of the system, are left open.
  void next(Eigen::VectorXd& q);

 private:
  const Problem& problem_;
  const std::vector<SearchRange>& ranges_;
  std::vector<double> place_, stride_; // in the unit cube
};

} // namespace flyball
