// Every equilibrium that a bounded search finds: many seeded starts spread over the coordinates' ranges, and
// from each equilibrium deflated runs that cannot find it again (Farrell, Birkisson and Funke, Deflation
// techniques for finding distinct solutions of nonlinear PDEs, 2015). No search of this kind can promise
// completeness.
#pragma once

#include "engine/equilibrium/newton.hpp"

#include <vector>

namespace flyball {

struct SearchRange {
  double lower = 0, upper = 0; // rad or m, as the joint labels its coordinate
};

struct SearchReport {
  std::vector<SearchRange>
      ranges;     // by coordinate in System::coordinates; driven ones from and to their drawn value
  int starts = 0; // Newton-Raphson runs, deflated ones included
};

struct EquilibriumList {
  std::vector<Unknowns> states; // distinct: whole turns of a joint without spring or stop count as one
  std::vector<NewtonOutcome> outcomes;
  SearchReport report;
};

// Ranges of the search: whole turns, and for slides twice the mechanism's reach around the drawn pose, the
// springs' free values and the stops.
std::vector<SearchRange> search_ranges(const Problem& problem, const Eigen::VectorXd& drawn);

// From `drawn` and all over the ranges. The same seed gives the same list.
EquilibriumList find_all_equilibria(const Problem& problem, const Eigen::VectorXd& drawn, unsigned seed,
                                    Workspace& w);

// Whether two configurations are one pose: scaled distance below `tolerance`, angles of unsprung joints
// modulo turns. `ignore` lists coordinates of q_R that do not count (neutral directions).
bool same_pose(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance,
               const std::vector<int>& ignore = {});

// The scaled step of q_R from one configuration to another, angles of unsprung joints the short way round.
Eigen::VectorXd scaled_difference(const Problem& problem, const Eigen::VectorXd& from,
                                  const Eigen::VectorXd& to);

} // namespace flyball
