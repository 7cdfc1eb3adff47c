// Starts, follows and shows the damped motion. No drawing.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

// The motion begins, and plays; or everything of it goes.
void show_motion(App& app, bool on);
// A new run from the chosen start, played from its beginning.
void restart_motion(App& app);
void stop_motion(App& app); // computing; what there is stays
// After the document's mechanism has changed.
void follow_motion(App& app, bool another);
// The same run again, with what is to be told of it now.
void retell_motion(App& app);
// Takes what was computed, moves nothing.
void update_motion(App& app);
// Moves playback.time on by `seconds` of motion, as far as the run goes.
void advance_motion(App& app, double seconds);
// Playback to a moment (s) of the run.
void seek_motion(App& app, double time);
// One sample on or back; playing ends.
void step_motion(App& app, int samples);

// The run that the view and the read-outs show; null: none.
const MotionRun* shown_motion(const App& app);
// Whether the motion is being computed.
bool computing_motion(const App& app);
// How much of the run that is being computed is there, s; none where nothing is computed.
std::optional<double> computed_motion(const App& app);
// "Motion, damped": only dampers make that difference.
std::string motion_words(const App& app, const MotionRun* motion);
// Whether there are dampers to be left out.
bool has_dampers(const Mechanism& mechanism);
// The names of the free coordinates, for a kick.
std::vector<std::string> free_coordinates(const App& app);
// The time (s) at which the steady state has the drives' phase that the motion has now.
double steady_time(const App& app);
// The same at a moment (s) of a run.
double steady_time(const Run& run, const Mechanism& mechanism, double time);
// Keeps the state at playback.time to start from.
void keep_motion_state(App& app);

} // namespace flyball
