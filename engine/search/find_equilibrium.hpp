// Which equilibrium is the answer, and which method found it.
//
// Newton-Raphson runs first, then from the stops that what hangs loose is pushed to, then damped, then by
// homotopy from rest, then where torques drive along the slow motion from the start, then downhill on the
// amended potential; for large mechanisms, where it takes few iterations, downhill comes second. Where there
// is a potential an answer counts only if it is a minimum that the assembled start can reach without
// climbing; Newton's habit of stopping at unstable states is met by going on downhill. A drawn pose that is
// itself a gyroscopically stable state is the answer, too: it is what the mechanism does from there. Without
// a potential Newton's answer stands, but see steady_state. Where torques drive a tree and the drawn pose is
// none to stay in, downhill comes second, too, at the speeds of the start: Newton-Raphson goes on from there
// with the speeds among the unknowns.
#pragma once

#include "engine/solve/newton.hpp"
#include "engine/solve/solution.hpp"

namespace flyball {

// What happened on the way to an equilibrium, beside the Status it ended with. report/messages has the words.
enum class Remark {
  none,
  // converged:
  left_unstable_start,       // the start is an unstable equilibrium; this is a minimum below it
  left_unstable_equilibrium, // Newton-Raphson arrived at an unstable one; this is a minimum below the start
  unstable,                  // and no minimum was found downhill from the start
  unstable_and_unbounded,    // and the potential falls on for hundreds of reaches
  left_unstable_speeds, // Newton-Raphson arrived at an unstable state; this is where the slow motion from the
                        // start goes, or from beside that state (steady_state)
  basin_uncertain,      // a minimum, but another may be the one below the start
  first_does_not_hold,  // what was found first holds at one phase only; this is another (steady_state)
  first_not_found,      // nothing was found from the start; this is from elsewhere (steady_state)
  // not converged:
  cancelled,
  unbounded,               // what was found lies far down a potential that falls on, and is not known well
  exhausted,               // no method found an equilibrium
  exhausted_and_unbounded, // and the potential falls on for hundreds of reaches
};

struct Found {
  Status status = Status::not_converged;
  Remark remark = Remark::none;
  Unknowns z;
  NewtonOutcome newton;
  std::optional<Fallback> fallback; // that found it where plain Newton-Raphson did not
  bool minimum = false; // a strict minimum of the amended potential on the constraints, and stable
  int iterations = 0;
  bool descended = false; // the descent of the potential was among the methods
  bool unbounded = false; // it went on for hundreds of reaches before this was settled for
  int open_cut = -1;      // infeasible: the worst cut joint, in System::cuts
  double opening = 0;     // infeasible: scaled
  int candidates = 0;     // by Fallback::search: steady states found, of which this is the nearest
};

// From `start`. `nearest` asks for the Newton answer, stable or not; `warm` says that the start is a
// neighbour's answer; `newton_only` that nothing catches Newton-Raphson where it fails. Reuses `found`'s
// storage, and allocates nothing when the plain run arrives in a system of the same size as before. An answer
// is left evaluated and factored in the workspace.
void find_equilibrium(const Problem& problem, const Eigen::VectorXd& start, bool nearest, bool warm,
                      Workspace& w, std::vector<double>& history, Found& found, bool newton_only = false);

// Whether each loop is in the assembly mode that was drawn: the rows of an axis' direction vanish where it
// points the other way, too.
bool same_assembly_mode(const Problem& problem, const Kinematics<double>& kinematics);

} // namespace flyball
