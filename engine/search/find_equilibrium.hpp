// Which equilibrium is the answer, and which net caught it.
//
// Newton-Raphson runs first, then damped, then by homotopy from rest, then downhill on the amended potential.
// Where there is a potential an answer counts only if it is a minimum that the assembled start can reach
// without climbing; Newton's habit of stopping at unstable states is met by going on downhill. A drawn pose
// that is itself a gyroscopically stable state is the answer, too: it is what the mechanism does from there.
// Without a potential Newton's answer stands.
#pragma once

#include "engine/solve/newton.hpp"
#include "engine/solve/solution.hpp"

#include <string>

namespace flyball {

struct Found {
  Status status = Status::not_converged;
  std::string message; // what happened on the way; empty for a plain run that arrived
  Unknowns z;
  NewtonOutcome newton;
  std::optional<Net> net;
  bool minimum = false; // a strict minimum of the amended potential on the constraints
  int iterations = 0;
  bool fell = false;  // the way downhill went on for hundreds of reaches before this was settled for
  int open_cut = -1;  // infeasible: the worst cut joint, in System::cuts
  double opening = 0; // infeasible: scaled
};

// From `start`. `nearest` asks for the Newton answer, stable or not; `warm` says that the start is a
// neighbour's answer. Reuses `found`'s storage, and allocates nothing when the plain run arrives in a system
// of the same size as before. An answer is left evaluated and factored in the workspace.
void find_equilibrium(const Problem& problem, const Eigen::VectorXd& start, bool nearest, bool warm,
                      Workspace& w, std::vector<double>& history, Found& found);

// Direction rows vanish for an axis turned right round, too: whether each loop is closed the way it was
// drawn.
bool closed_the_right_way(const Problem& problem, const Kinematics<double>& kinematics);

} // namespace flyball
