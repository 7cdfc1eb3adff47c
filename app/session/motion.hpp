// The damped motion beside the steady state: how it is wanted, and the run so far. Nothing of it is made
// before a person asks for the motion.
#pragma once

#include "app/live/motion.hpp"
#include "engine/dynamics/settled.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

// One of two runs: with the dampers on, and off.
struct MotionRun {
  bool wanted = true;
  std::unique_ptr<Background<Motion>> task;
  bool told = false;              // anything has come of what was asked for last
  std::shared_ptr<const Run> run; // until then of an earlier request; null: none
  bool finished = false;
  std::string problem;                        // why there is no run, or no more of it
  std::shared_ptr<const Solution> rests_in{}; // see Motion
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
  std::vector<Pose> poses;       // of the shown run at playback.time; empty: none
  std::optional<Settled> settled;
  bool nearly_settled = false; // at the end, and for its last tenth, as near as a plot hardly shows
  std::shared_ptr<const Solution>
      elsewhere{}; // another steady state that the shown run runs into; null: none
  // What these two are of.
  struct Of {
    std::shared_ptr<const Run> run;
    double time = -1;         // s
    std::uint64_t answer = 0; // its ticket
  } shown;
};

// The motion begins, and plays; or everything of it goes.
void show_motion(Session& session, bool on);
// A new run from the chosen start, played from its beginning.
void restart_motion(Session& session);
void stop_motion(Session& session); // computing; what there is stays
// After the document's mechanism has changed.
void follow_motion(Session& session, bool another);
// The same run again, with what is to be told of it now.
void retell_motion(Session& session);
// Takes what was computed, moves nothing.
void update_motion(Session& session);
// Moves playback.time on by `seconds` of motion, as far as the run goes.
void advance_motion(Session& session, double seconds);
// Playback to a moment (s) of the run.
void seek_motion(Session& session, double time);
// One sample on or back; playing ends.
void step_motion(Session& session, int samples);

// The run that the view and the read-outs show; null: none.
const MotionRun* shown_motion(const Session& session);
// Whether the motion is being computed.
bool computing_motion(const Session& session);
// How much of the run that is being computed is there, s; none where nothing is computed.
std::optional<double> computed_motion(const Session& session);
// "Motion, damped": only dampers make that difference.
std::string motion_words(const Session& session, const MotionRun* motion);
// "It settles in another steady state: arm1 at 139.36°, arm2 at 139.36°."; empty where it does not.
std::string elsewhere_words(const Session& session);
// Goes to that one.
void go_elsewhere(Session& session);
// Whether the shown run has settled, in the units of the screen: "Nearly settled after 12 s: arm1 is 0.063°
// from the steady state."; empty where that is not known.
std::string settled_words(const Session& session);
// Why there is no motion, or no more of it; of two each says which it is.
std::vector<std::string> motion_problems(const Session& session);
// Whether there are dampers to be left out.
bool has_dampers(const Mechanism& mechanism);
// The names of the free coordinates, for a kick.
std::vector<std::string> free_coordinates(const Session& session);
// The time (s) at which the steady state has the drives' phase that the motion has now.
double steady_time(const Session& session);
// The same at a moment (s) of a run.
double steady_time(const Run& run, const Mechanism& mechanism, double time);
// Keeps the state at playback.time to start from.
void keep_motion_state(Session& session);

} // namespace flyball
