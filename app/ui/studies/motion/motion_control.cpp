#include "app/ui/studies/motion/motion_control.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double samples_per_run = 2000; // for plots that stay smooth when they are zoomed
constexpr double least_rate = 100;       // 1/s

SimulationOptions options_of(const App& app, bool damped) {
  const MotionState& motion = app.motion;
  SimulationOptions options;
  options.duration = motion.duration;
  options.rate = std::max(least_rate, samples_per_run / motion.duration);
  options.tolerance = motion.tolerance;
  options.method = motion.method;
  options.damped = damped;
  options.start = motion.start;
  options.reactions = true;
  constexpr std::size_t many = 60; // bodies; their motions would take more memory than they are worth
  if (app.mechanism().bodies.size() <= many)
    for (const Body& body : app.mechanism().bodies)
      options.points.push_back({body.name});
  for (BodyPoint& point : told_points(app))
    options.points.push_back(std::move(point));
  if (motion.start == Start::state) options.state = motion.saved;
  if (motion.start == Start::equilibrium) {
    const std::vector<std::string> names = free_coordinates(app);
    const bool known = std::ranges::find(names, motion.kicked) != names.end();
    if (known || !names.empty()) options.kick = {{known ? motion.kicked : names.front(), motion.kick}};
  }
  return options;
}

bool fit_to_run(const App& app) {
  return !app.mechanism().bodies.empty() && app.mistakes.empty();
}

void ask(App& app, bool go_on) {
  MotionState& motion = app.motion;
  const bool dampers = has_dampers(app.mechanism());
  for (std::size_t i = 0; i < motion.runs.size(); ++i) {
    MotionRun& run = motion.runs[i];
    const bool damped = i == 0;
    if (!run.wanted || (!damped && !dampers && motion.runs[0].wanted) || !fit_to_run(app)) {
      run = {.wanted = run.wanted, .live = nullptr, .run = nullptr, .problem = {}};
      continue;
    }
    if (!run.live) run.live = std::make_unique<LiveMotion>(app.options.mode, app.options.on_news);
    const SimulationOptions options = options_of(app, damped);
    run.asked = go_on && run.run ? run.live->go_on(app.document.shared(), options, run.run, app.playback.time)
                                 : run.live->start(app.document.shared(), options);
    run.finished = false;
    run.problem.clear();
  }
  ++motion.version;
}

// The value of a track at a time, between samples.
double value_at(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto later = std::ranges::upper_bound(times, time);
  if (later == times.begin()) return values.front();
  if (later == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(later - times.begin());
  const double part = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + part * (values[i] - values[i - 1]);
}

} // namespace

bool has_dampers(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints,
                             [](const Joint& joint) {
                               return std::ranges::any_of(joint.coordinates,
                                                          [](const Coordinate& c) { return c.damping != 0; });
                             }) ||
         std::ranges::any_of(mechanism.forces, [](const Force& force) { return force.damping != 0; });
}

const MotionRun* shown_motion(const App& app) {
  for (const MotionRun& run : app.motion.runs)
    if (run.wanted && run.run && !run.run->time.empty()) return &run;
  return nullptr;
}

bool computing_motion(const App& app) {
  return app.motion.on && std::ranges::any_of(app.motion.runs, [](const MotionRun& run) {
           return run.asked != 0 && run.live && !run.finished;
         });
}

std::optional<double> computed_motion(const App& app) {
  if (!computing_motion(app)) return std::nullopt;
  double least = app.motion.duration;
  for (const MotionRun& motion : app.motion.runs) {
    if (motion.asked == 0 || !motion.live || motion.finished) continue;
    // Until something of the new run has come, what there is may be another's.
    const bool any = motion.answered == motion.asked && motion.run && !motion.run->time.empty();
    least = std::min(least, any ? motion.run->time.back() - motion.run->time.front() : 0);
  }
  return least;
}

std::string motion_words(const App& app, const MotionRun* motion) {
  if (!has_dampers(app.mechanism())) return "Motion";
  return !motion || !motion->run || motion->run->damped ? "Motion, damped" : "Motion, without dampers";
}

std::vector<std::string> free_coordinates(const App& app) {
  std::vector<std::string> names;
  for (const CoordinateSolution& c : app.answer.summary.coordinates)
    if (!c.driven && !c.dependent) names.push_back(coordinate_label(c));
  return names;
}

void show_motion(App& app, bool on) {
  if (on == app.motion.on) return;
  if (!on) {
    for (MotionRun& run : app.motion.runs)
      run = {.wanted = run.wanted, .live = nullptr, .run = nullptr, .problem = {}};
    app.motion.on = false;
    app.motion.poses.clear();
    app.motion.settled.reset();
    ++app.motion.version;
    play(app, false);
    rewind(app);
    return;
  }
  app.motion.on = true;
  restart_motion(app);
}

void restart_motion(App& app) {
  app.motion.on = true;
  ask(app, false);
  app.playback.time = app.motion.start == Start::state ? app.motion.saved.time : 0;
  app.moved_time = true;
  play(app, fit_to_run(app));
}

void stop_motion(App& app) {
  for (MotionRun& run : app.motion.runs)
    if (run.live) run.live->stop();
}

void follow_motion(App& app, bool another) {
  if (another) {
    app.motion = MotionState{};
    app.motion.duration = app.mechanism().simulation.duration;
    app.motion.runs[0].wanted = app.mechanism().simulation.damped || !has_dampers(app.mechanism());
    app.study = {};
  }
  if (!app.motion.on) return;
  const bool go_on = app.motion.go_on && shown_motion(app);
  ask(app, go_on);
  // Who has paused looks at a moment, which stays.
  if (!go_on && app.playback.playing)
    seek_motion(app, app.motion.start == Start::state ? app.motion.saved.time : 0);
}

void retell_motion(App& app) {
  if (!app.motion.on) return;
  ask(app, false);
  if (app.playback.playing) seek_motion(app, app.motion.start == Start::state ? app.motion.saved.time : 0);
}

void update_motion(App& app) {
  MotionState& motion = app.motion;
  if (!motion.on) return;
  bool news = false;
  for (MotionRun& run : motion.runs) {
    if (!run.live) continue;
    std::optional<MotionNews> taken = run.live->take();
    if (!taken || taken->ticket != run.asked) continue;
    news = true;
    run.answered = taken->ticket;
    run.finished = taken->finished;
    run.problem = taken->error.value_or("");
    run.run = std::move(taken->run);
    if (run.run && run.run->status == RunStatus::diverged) run.problem = run.run->message;
  }
  if (news) {
    ++motion.version;
    app.moved_time = true; // the drives may stand elsewhere in the new run, see steady_time()
  }
  const MotionRun* shown = shown_motion(app);
  if (!shown) {
    motion.poses.clear();
    motion.settled.reset();
    return;
  }
  const Run& run = *shown->run;
  if (motion.posed != app.playback.time || motion.posed_version != motion.version) {
    motion.poses = poses_at(run, app.playback.time);
    motion.posed = app.playback.time;
  }
  if (motion.posed_version != motion.version || motion.settled_ticket != app.answer.ticket) {
    motion.settled.reset();
    if (run.damped && converged(app) && !solving(app))
      motion.settled = find_settled(run, app.answer.solution);
    motion.settled_ticket = app.answer.ticket;
  }
  motion.posed_version = motion.version;
}

void advance_motion(App& app, double seconds) {
  const MotionRun* shown = shown_motion(app);
  if (!shown) return;
  const std::vector<double>& times = shown->run->time;
  double time = app.playback.time + seconds;
  if (time >= times.back()) {
    time = times.back();
    if (shown->finished) { // else what is still being computed is waited for
      if (app.motion.loop && times.back() > times.front())
        time = times.front();
      else
        app.playback.playing = false;
    }
  }
  seek_motion(app, time);
}

void seek_motion(App& app, double time) {
  if (const MotionRun* shown = shown_motion(app))
    time = std::clamp(time, shown->run->time.front(), shown->run->time.back());
  app.playback.time = time;
  app.moved_time = true;
}

void step_motion(App& app, int samples) {
  const MotionRun* shown = shown_motion(app);
  if (!shown) return;
  app.playback.playing = false;
  const std::vector<double>& times = shown->run->time;
  const auto now = static_cast<long>(sample_before(*shown->run, app.playback.time + 1e-12));
  // From between two samples, back means to the one before.
  const long back = samples < 0 && times[static_cast<std::size_t>(now)] < app.playback.time - 1e-9 ? 1 : 0;
  const long to = std::clamp(now + samples + back, 0L, static_cast<long>(times.size()) - 1);
  seek_motion(app, times[static_cast<std::size_t>(to)]);
}

double steady_time(const App& app) {
  const MotionRun* shown = app.motion.on ? shown_motion(app) : nullptr;
  return shown && app.answer.mechanism ? steady_time(*shown->run, *app.answer.mechanism, app.playback.time)
                                       : app.playback.time;
}

double steady_time(const Run& run, const Mechanism& mechanism, double time) {
  // After a change of speed on the way, one drive's phase can be met at another time; those of several
  // cannot.
  const CoordinateTrack* driven = nullptr;
  for (const CoordinateTrack& track : run.coordinates)
    if (track.driven) {
      if (driven) return time;
      driven = &track;
    }
  if (!driven) return time;
  const int j = joint_index(mechanism, driven->joint);
  if (j < 0) return time;
  const auto& coordinates = mechanism.joints[static_cast<std::size_t>(j)].coordinates;
  const auto i = static_cast<std::size_t>(driven->index);
  if (i >= coordinates.size() || !coordinates[i].drive || coordinates[i].drive->speed == 0) return time;
  return (value_at(run.time, driven->value, time) - coordinates[i].drawn) / coordinates[i].drive->speed;
}

void keep_motion_state(App& app) {
  const MotionRun* shown = shown_motion(app);
  if (!shown) return;
  app.motion.saved = state_at(*shown->run, sample_before(*shown->run, app.playback.time + 1e-12));
  app.notice = "The state of the motion is kept to start from.";
}

} // namespace flyball
