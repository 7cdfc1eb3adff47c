// Steady states in which what turns at speeds that are found stands at another angle than drawn: two shafts
// that a spring ties, or that close a loop through one, turn alike, the one some way behind the other.
//
// Angles along which the balance or the loops change cannot drift as the drives turn on. With E what they
// change by the angles that are found, V a basis of these along which gears and what else is tied by rates
// stay closed, M = (E V)^+ E, and w the speeds, M w + h = 0, h what drives at given speeds do; that is as
// many equations as there are angles along V, and Newton-Raphson solves them by these, the speeds being those
// of the balance there.
#pragma once

#include "engine/solve/newton.hpp"

#include <optional>
#include <vector>

namespace flyball {

// Of what turns at speeds that are found, and h by the speeds of other drives.
struct AngleTies {
  std::vector<int> found, given; // links
  Eigen::MatrixXd along;         // V (found, ties): rad or m
  Eigen::MatrixXd of_found;      // M^T (found, ties)
  Eigen::MatrixXd of_given;      // (given, ties); both in 1/rad, or 1/m
};

// What they are of this problem; nothing where nothing ties angles, or nobody looks for such states.
std::optional<AngleTies> find_angle_ties(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);
// Whether they tie the same angles alike, which most numbers leave as it is, and ratios of gears do not.
bool tie_alike(const AngleTies& a, const AngleTies& b);
// Along V (rad, or parts of the reach), but for whole turns, from one state to another; by link.
Eigen::VectorXd angles_between(const Problem& problem, const AngleTies& ties, const Eigen::VectorXd& from,
                               const Eigen::VectorXd& to);
// Turns what is tied by steps along V.
void turn_along(const AngleTies& ties, const Eigen::VectorXd& step, Eigen::VectorXd& starts);

struct TurnedState {
  Eigen::VectorXd starts; // by link: rad or m, Parameters::links[].start
  AngleTies ties;
  Unknowns z;
  Eigen::VectorXd error;       // of q, as steps: estimated
  int iterations = 0;          // of Newton-Raphson, at all the angles on the way
  std::vector<double> history; // scaled residuals of these
};

// With what turns at its angles.
Parameters at_angles_of(const Parameters& drawn, const TurnedState& state);

// From q, looked for from several angles, one that holds at every phase, a stable one before others; those
// that come to rest are left out. Of small problems with speeds that are found.
std::optional<TurnedState> find_turned_state(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);
// The one beside another, that of numbers beside these. Whether it holds is not looked at. Nothing where
// Newton-Raphson from there finds none.
std::optional<TurnedState> find_turned_state_beside(const Problem& problem, const TurnedState& other,
                                                    Workspace& w);

} // namespace flyball
