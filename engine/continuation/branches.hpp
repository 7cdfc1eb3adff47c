// The response of a mechanism to one parameter: branches of equilibria, their stability, and the points where
// they fold, cross or begin to flutter.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/solve/solution.hpp"
#include "engine/task/progress.hpp"

#include <atomic>
#include <functional>
#include <optional>

namespace flyball {

struct ResponsePoint {
  double parameter = 0;
  std::vector<CoordinateSolution> coordinates;
  std::optional<bool> stable;
  std::optional<StabilityReason> stability_reason;
  std::vector<std::complex<double>> eigenvalues; // 1/s, each point's in their own order
  std::optional<Floquet> floquet;                // where the linearised motion turns with the drives
  std::vector<Reaction> reactions;               // where BranchOptions::reactions asks for them
  std::vector<DriveTorque> drive_torques;        // likewise
  std::vector<MeasureSolution> measures;         // the scene's, in its order
  bool singular_loops = false;                   // its eigenvalues belong to no modes
  std::string kinks;                             // a sentence on each law on a kink of which it stands
  std::vector<FrictionForce> frictions;          // where the state rests on dry friction: what it rests on
  std::optional<double> parameter_error;         // of a special point; nothing where it is not known
};

enum class SpecialPointType {
  fold,         // the branch turns back
  branch_point, // another branch crosses
  hopf,         // a damped pair of eigenvalues crosses the imaginary axis
  parametric,   // a real Floquet multiplier leaves the unit circle: the drives pump a motion up
  flutter,      // two undamped pairs meet on the imaginary axis and leave it, whatever is damped elsewhere
  slip, // a state that rests on dry friction ends: a joint begins to slip, or comes to rest and sticks
};
std::string_view word(SpecialPointType type);

struct SpecialPoint {
  SpecialPointType type = SpecialPointType::fold;
  ResponsePoint at;
  int branch = 0;
};

// The end of a branch that comes back to where it began.
inline constexpr std::string_view closed_branch = "closed";

struct ResponseBranch {
  std::vector<ResponsePoint> points;
  std::string end;   // why it stops at its last point, in words
  std::string begin; // why it begins at its first, where it was followed both ways; else empty
  // Reached from the drawn pose's equilibrium, or from the answer that solving gives there, through
  // crossings; false where it was begun from the list of all equilibria (BranchOptions::all).
  bool connected = true;
};

struct ResponseDiagram {
  Status status = Status::not_converged; // of the start, or converged where `all` found another branch
  std::string message;                   // a sentence or two
  std::vector<ResponseBranch> branches;
  std::vector<SpecialPoint> special;
  std::vector<double> searched; // values of the parameter at which all equilibria were looked for
  int starts = 0;               // Newton-Raphson runs of that search, which is bounded and may miss some
  // The one connected with the drawn pose is of states that stand turned (Solution::turned). It is not
  // followed along a number that changes which angles are tied to each other, as a gear's ratio does.
  bool turned = false;
  double run_time_s = 0;
};

struct BranchOptions {
  double largest_step = 0.02; // scaled: radians, reaches, speeds, and parts of the parameter's range
  int max_points = 2000;      // a branch
  int max_branches = 32;
  bool switch_branches = true;
  // Of points up to `dense_up_to` coordinates, and of mechanisms without a potential.
  bool eigenvalues = true;
  // Coordinates beyond which, where there is a potential, the KKT matrix is in the system's own form rather
  // than by dense matrices: then stability is what the signs of pivots tell of it, and Hopf points and
  // flutter are not looked for.
  int dense_up_to = 200;
  bool reactions = false; // of every point: costs about as much as the point itself
  // Also the branches that nothing connects with the drawn pose's: from each equilibrium that
  // find_all_equilibria finds at the values `all_at`, both ways, where it lies on no branch yet.
  bool all = false;
  std::vector<double> all_at; // values of the parameter; empty: both ends, and the present one where between
  // Whether a steady state that stands turned against the drawn pose (Solution::turned) is followed.
  bool turned = true;
  const std::atomic<bool>* cancel = nullptr;
  ReportProgress progress; // `part` is of the range, along the first branch; else of what is searched
  // With `all`, told what is there before the search at each value; not before there is a branch.
  std::function<void(const ResponseDiagram&)> publish;
};

// Starts at `from`, solved nearest to the drawn pose, and where that is unstable also from the answer that
// Analysis::solve would give there; follows these branches towards `to` (which may be
// smaller), then whatever branches off it, then what BranchOptions::all asks for. Throws SceneError for an
// address that does not exist.
ResponseDiagram follow_branches(const Mechanism& mechanism, const std::string& address, double from,
                                double to, const BranchOptions& options = {});

// The branch of the equilibrium nearest to `state` at its parameter, followed both ways from there, then
// whatever branches off it. Nothing where there is no steady state near it or its parameter lies outside the
// range. Throws as follow_branches does.
std::optional<ResponseDiagram> follow_branches_through(const Mechanism& mechanism, const std::string& address,
                                                       double from, double to, const ResponsePoint& state,
                                                       const BranchOptions& options);

// The speed of a drive by torque is found: nothing follows from where its search begins. Throws SceneError
// where the address is that.
void expect_no_found_speed(const Mechanism& mechanism, const std::string& address);

} // namespace flyball
