// The damped motion beside the steady state: how it is wanted, and the run so far. Nothing of it is made
// before a person asks for the motion.
#pragma once

#include "app/live/live_motion.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "engine/dynamics/settled.hpp"

#include <array>

namespace flyball {

// One of two runs: with the dampers on, and off.
struct MotionRun {
  bool wanted = true;
  std::unique_ptr<LiveMotion> live;
  std::uint64_t asked = 0;        // ticket; 0: nothing asked for yet
  std::uint64_t answered = 0;     // the newest ticket of which anything has come
  std::shared_ptr<const Run> run; // may still be that of an earlier request; null: none
  bool finished = false;
  std::string problem; // why there is no run, or no more of it
};

// A plot over time.
struct MotionPlot {
  std::string quantity; // see motion_quantities(); empty: not shown
  PlotView view;
  Plot plot;                // drawn from `made`
  std::uint64_t made = 0;   // MotionState::version
  std::string made_for;     // quantity
  std::uint64_t ticket = 0; // of the answer whose steady value it shows
};

struct MotionState {
  bool on = false;
  // How a run is wanted.
  double duration = 10;    // s
  double tolerance = 1e-8; // of the error of a step
  Integrator method = Integrator::automatic;
  Start start = Start::rest;
  std::string kicked;    // a coordinate; "": the first that is free
  double kick = 1;       // rad/s, m/s
  SimulationState saved; // to start from; without coordinates: none
  bool go_on = false;    // what changes a number goes on with the run rather than beginning anew
  bool loop = false;
  bool beside = false; // in a view of its own

  std::array<MotionRun, 2> runs; // damped, undamped
  std::uint64_t version = 1;     // of what the plots show
  std::vector<Pose> poses;       // of the shown run at playback.time; empty: none
  double posed = -1;             // s, the time of these poses
  std::uint64_t posed_version = 0;
  std::optional<Settled> settled;
  std::uint64_t settled_ticket = 0; // of the answer it was found for
  std::array<MotionPlot, 2> plots;
  std::uint64_t plots_made = 0; // so far, for their versions
};

} // namespace flyball
