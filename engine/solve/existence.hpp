// Whether a balance found at one phase of the drives holds at every phase: only then is it a steady state.
#pragma once

#include "engine/solve/newton.hpp"

namespace flyball {

struct Existence {
  bool holds = true;
  bool loops_open = false; // a constraint cannot be kept; else the forces do not stay balanced
  double phase = 0;        // s, where it fails worst
  double violation = 0;    // scaled
  int worst_cut = -1;      // loops_open: in System::cuts
  double left = 0;         // where it holds: the largest imbalance at another phase, scaled
  int pushed = -1;         // in System::torques: a drive left to itself on which something acts
  int rubs = -1;           // a link: see rubbing_link()
  bool varies = false;     // where it holds: the errors are what other phases ask it to move, not rounding
};

// A link that turns or slides at a speed that is found, with dry friction against it, which no balance here
// has: states with it are others (report/friction_state). -1: none.
int rubbing_link(const System& system, const Parameters& parameters);

// Times (s) along q_D(t) at which to look at the state q: phase_times(). Empty where the mechanism's shape
// alone makes every phase alike.
std::vector<double> sample_phases(const System& system, const Parameters& parameters,
                                  const Eigen::VectorXd& q);

// At each phase Phi must vanish and the force balance must lie in the range of Phi_q^T, and nothing may act
// along the coordinates of drives left to themselves.
Existence check_existence(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                          Workspace& w);

// How far (rad, m), by coordinate of q_R, the balance at other phases asks a state that holds within the
// tolerance to move: twice the largest Newton step there.
Eigen::VectorXd phase_variation(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                                Workspace& w);

} // namespace flyball
