// Where a motion that nothing times from outside, as of a governor that hunts, begins to repeat itself: from
// there shooting finds the limit cycle and its period.
#pragma once

#include "engine/periodic/state_chart.hpp"
#include "engine/task/progress.hpp"

namespace flyball {

// What is told while a motion is followed to where it comes to.
inline constexpr const char* following_phase = "following a motion";

// Whether all rates stay as they are, scaled by `rate` (1/s): everything rests or turns evenly.
bool is_steady(const Flow& flow, const std::vector<FlowState>& states, double rate);

enum class CycleStart {
  steady, // the motion that leaves the steady state where that is unstable; where it is stable its swing
          // alone
  drawn,  // the motion from the drawn pose
};

// What is told of a motion that has become steady where a cycle was looked for: a sentence or two. `rate` as
// above; a drive by a torque that has come to rest is told with where it stands.
std::string settled_message(const Flow& flow, CycleStart start, const FlowState& state, double rate);

// Angles of what torques drive that need not return after a period.
AlikeAngles angles_alike(Flow& flow, const FlowState& state, double rate);

// Whether motions from `state` and beside it go alike wherever the drives, whose period this is (s), stand:
// then there may be limit cycles though drives turn at prescribed speeds, as of a pendulum on a turning
// shaft.
bool goes_alike_at_phases(Flow& flow, const FlowState& state, double period);

// The same of one of several drives, at `speed` (rad/s), where the others have this period (s): then theirs
// is the motion's, as with a balanced rotor beside an unbalanced one.
bool goes_alike_without(Flow& flow, const FlowState& state, double period, double speed);

struct CycleGuess {
  double period = 0; // s
  AlikeAngles alike;
  std::optional<FlowState> steady;
  std::optional<FlowState> state; // of a motion that nearly repeats itself
  // Without it: the shape of the least damped swing about the steady state, in StateChart's coordinates
  // there, its largest entry 1. Around a stable steady state an unstable cycle may lie, beyond which it
  // hunts.
  Eigen::VectorXd swing;
};

struct CycleOutcome {
  std::optional<CycleGuess> guess;
  std::string trouble; // where there is none: a sentence
};

// A steady state about which something grows; `rate` (1/s) is the unit of rates, as that of a drive.
struct UnstableState {
  FlowState state;
  double rate = 1;
};

// A motion is followed until it nearly returns and grows no more, or for as long as the flow allows. The
// period is first that of the least damped swing about the steady state, else a turn of what a torque drives.
// `around`: the steady state to leave, in place of the mechanism's solution.
CycleOutcome guess_cycle(Flow& flow, const Mechanism& mechanism, CycleStart start,
                         const std::atomic<bool>* cancel, const ReportProgress& progress,
                         const std::optional<UnstableState>& around = {});

} // namespace flyball
