#include "app/session/motion.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/session.hpp"
#include "app/session/units.hpp"
#include "engine/dynamics/joined.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball {

namespace {

constexpr double samples_per_run = 2000; // for plots that stay smooth when they are zoomed
constexpr double least_rate = 100;       // 1/s

SimulationOptions options_of(const Session& session, bool damped) {
  const MotionState& motion = session.motion;
  SimulationOptions options;
  options.duration = motion.duration;
  options.rate = std::max(least_rate, samples_per_run / motion.duration);
  options.tolerance = motion.tolerance;
  options.method = motion.method;
  options.damped = damped;
  options.start = motion.start;
  options.reactions = true;
  constexpr std::size_t many = 60; // bodies; their motions would take more memory than they are worth
  if (session.mechanism().bodies.size() <= many)
    for (const Body& body : session.mechanism().bodies)
      options.points.push_back({body.name});
  for (BodyPoint& point : told_points(session))
    options.points.push_back(std::move(point));
  if (motion.start == Start::state) options.state = motion.saved;
  if (motion.start == Start::equilibrium) {
    const std::vector<std::string> names = free_coordinates(session);
    const bool known = std::ranges::find(names, motion.kicked) != names.end();
    if (known || !names.empty()) options.kick = {{known ? motion.kicked : names.front(), motion.kick}};
  }
  return options;
}

bool fit_to_run(const Session& session) {
  return !session.mechanism().bodies.empty() && session.mistakes.empty();
}

void ask(Session& session, bool go_on) {
  MotionState& motion = session.motion;
  const bool dampers = has_dampers(session.mechanism());
  for (std::size_t i = 0; i < motion.runs.size(); ++i) {
    MotionRun& run = motion.runs[i];
    const bool damped = i == 0;
    if (!run.wanted || (!damped && !dampers && motion.runs[0].wanted) || !fit_to_run(session)) {
      run = {.wanted = run.wanted, .task = nullptr, .run = nullptr, .problem = {}};
      continue;
    }
    if (!run.task)
      run.task = std::make_unique<Background<Motion>>(session.options.mode, session.options.on_news);
    run.task->start([request = MotionRequest{session.document.shared(), options_of(session, damped),
                                             go_on ? run.run : nullptr, session.playback.time}](
                        const TaskContext<Motion>& context) { return compute_motion(request, context); });
    run.told = run.finished = false;
    run.problem.clear();
  }
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

// For the last tenth of the run, so that what swings past is not taken for it.
bool nearly_settled(const Run& run, const Settled& settled, const Solution& steady) {
  constexpr double nearly = 0.02; // of a radian or the mechanism's size: a plot hardly shows it
  if (settled.time || !(settled.distance < nearly)) return false;
  const std::optional<double> since = find_settled(run, steady, nearly).time;
  return since && *since < 0.9 * (run.time.back() - run.time.front());
}

} // namespace

bool has_dampers(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.joints,
                             [](const Joint& joint) {
                               return std::ranges::any_of(joint.coordinates,
                                                          [](const Coordinate& c) { return is_damped(c); });
                             }) ||
         std::ranges::any_of(mechanism.forces, [](const Force& force) {
           return is_damped(force) ||
                  std::ranges::any_of(force.bearing_damping, [](double c) { return c != 0; });
         });
}

const MotionRun* shown_motion(const Session& session) {
  for (const MotionRun& run : session.motion.runs)
    if (run.wanted && run.run && !run.run->time.empty()) return &run;
  return nullptr;
}

bool computing_motion(const Session& session) {
  return session.motion.on && std::ranges::any_of(session.motion.runs, [](const MotionRun& run) {
           return run.task && !run.finished;
         });
}

std::optional<double> computed_motion(const Session& session) {
  if (!computing_motion(session)) return std::nullopt;
  double least = session.motion.duration;
  for (const MotionRun& motion : session.motion.runs) {
    if (!motion.task || motion.finished) continue;
    // Until something of the new run has come, what there is may be another's.
    const bool any = motion.told && motion.run && !motion.run->time.empty();
    least = std::min(least, any ? motion.run->time.back() - motion.run->time.front() : 0);
  }
  return least;
}

std::string motion_words(const Session& session, const MotionRun* motion) {
  if (!has_dampers(session.mechanism())) return "Motion";
  return !motion || !motion->run || motion->run->damped ? "Motion, damped" : "Motion, without dampers";
}

std::string settled_words(const Session& session) {
  const MotionRun* shown = shown_motion(session);
  if (!session.motion.settled || !shown) return {};
  const Settled& settled = *session.motion.settled;
  if (!settled.farthest || !std::isfinite(settled.distance)) return settled.message;
  const FarCoordinate& far = *settled.farthest;
  const ShownUnit unit =
      far.speed ? rate_unit(far.angle, session.units) : coordinate_unit(far.angle, session.units);
  const std::string away = (far.speed ? "the speed of " : "") + coordinate_words(far) + " is " +
                           short_text(unit.factor * far.away, 2) + (unit.text == "°" ? "" : " ") + unit.text +
                           " from the steady state.";
  if (settled.held) return "Friction holds it where it has come to rest: " + away;
  if (settled.time) return "Settled after " + short_text(*settled.time, 4) + " s; at the end " + away;
  const std::vector<double>& times = shown->run->time;
  const std::string after = " after " + short_text(times.back() - times.front(), 4) + " s: " + away;
  if (session.answer.solution.stable == false) return "Not settled, as the steady state is unstable;" + after;
  if (session.motion.nearly_settled && !computing_motion(session)) return "Nearly settled" + after;
  return "Not settled" + after;
}

std::string elsewhere_words(const Session& session) {
  if (!session.motion.elsewhere) return {};
  const Solution& there = *session.motion.elsewhere;
  constexpr double apart = 1e-3;   // of a radian or the reach
  constexpr std::size_t named = 3; // coordinates
  std::vector<std::string> places;
  for (std::size_t i = 0; i < there.coordinates.size(); ++i) {
    const CoordinateSolution& c = there.coordinates[i];
    if (std::abs(value_difference(session.answer.solution.coordinates[i], c)) < apart) continue;
    const ShownUnit unit = coordinate_unit(c.angle, session.units);
    places.push_back(coordinate_words(c) + " at " + short_text(unit.shown(c.value), 5) +
                     (unit.text == "°" ? "" : " ") + unit.text);
  }
  if (places.size() > named + 1) {
    const std::size_t more = places.size() - named;
    places.resize(named);
    places.push_back("and " + std::to_string(more) + " more");
  }
  std::string words = "It settles in another steady state";
  for (std::size_t i = 0; i < places.size(); ++i)
    words += (i == 0 ? ": " : ", ") + places[i];
  return words + ".";
}

void go_elsewhere(Session& session) {
  if (const auto there = session.motion.elsewhere)
    go_to_state(session, "", 0, start_values(there->coordinates));
}

std::vector<std::string> motion_problems(const Session& session) {
  const auto& runs = session.motion.runs;
  const bool both = std::ranges::all_of(runs, [](const MotionRun& run) { return run.wanted && run.task; });
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].wanted && !runs[i].problem.empty())
      problems.push_back((!both ? "" : i == 0 ? "Damped: " : "Undamped: ") + runs[i].problem);
  return problems;
}

std::vector<std::string> free_coordinates(const Session& session) {
  std::vector<std::string> names;
  for (const CoordinateSolution& c : session.answer.summary.coordinates)
    if (!c.driven && !c.dependent) names.push_back(coordinate_label(c));
  return names;
}

void show_motion(Session& session, bool on) {
  if (on == session.motion.on) return;
  if (!on) {
    for (MotionRun& run : session.motion.runs)
      run = {.wanted = run.wanted, .task = nullptr, .run = nullptr, .problem = {}};
    session.motion.on = false;
    session.motion.poses.clear();
    session.motion.settled.reset();
    session.motion.elsewhere.reset();
    session.motion.shown = {};
    play(session, false);
    rewind(session);
    return;
  }
  session.motion.on = true;
  restart_motion(session);
}

void restart_motion(Session& session) {
  session.motion.on = true;
  ask(session, false);
  session.playback.time = session.motion.start == Start::state ? session.motion.saved.time : 0;
  session.moved_time = true;
  play(session, fit_to_run(session));
}

void stop_motion(Session& session) {
  for (MotionRun& run : session.motion.runs)
    if (run.task) run.task->cancel();
}

void follow_motion(Session& session, bool another) {
  if (another) {
    session.motion = MotionState{};
    session.motion.duration = session.mechanism().simulation.duration;
    session.motion.runs[0].wanted =
        session.mechanism().simulation.damped || !has_dampers(session.mechanism());
    session.study = {};
  }
  if (!session.motion.on) return;
  const bool go_on = session.motion.go_on && shown_motion(session);
  ask(session, go_on);
  // Who has paused looks at a moment, which stays.
  if (!go_on && session.playback.playing)
    seek_motion(session, session.motion.start == Start::state ? session.motion.saved.time : 0);
}

void retell_motion(Session& session) {
  if (!session.motion.on) return;
  ask(session, false);
  if (session.playback.playing)
    seek_motion(session, session.motion.start == Start::state ? session.motion.saved.time : 0);
}

void update_motion(Session& session) {
  MotionState& motion = session.motion;
  if (!motion.on) return;
  bool news = false;
  for (MotionRun& run : motion.runs) {
    const auto taken = run.task ? run.task->take() : std::nullopt;
    if (!taken) continue;
    news = run.told = true;
    run.finished = !taken->result || taken->result->finished;
    run.problem = taken->result ? taken->result->problem : taken->problem;
    run.rests_in = taken->result ? taken->result->rests_in : nullptr;
    run.run = taken->result ? std::move(taken->result->run) : nullptr;
    if (run.run && run.run->status == RunStatus::diverged) run.problem = run.run->message;
  }
  if (news) session.moved_time = true; // the drives may stand elsewhere in the new run, see steady_time()
  const MotionRun* shown = shown_motion(session);
  if (!shown) {
    motion.poses.clear();
    motion.settled.reset();
    motion.nearly_settled = false;
    motion.elsewhere.reset();
    motion.shown = {};
    return;
  }
  const Run& run = *shown->run;
  const MotionState::Of before = std::exchange(
      motion.shown, {.run = shown->run, .time = session.playback.time, .answer = session.answer.ticket});
  if (before.run != shown->run || before.time != session.playback.time)
    motion.poses = poses_at(run, session.playback.time);
  if (before.run != shown->run || before.answer != session.answer.ticket) {
    motion.settled.reset();
    motion.nearly_settled = false;
    motion.elsewhere.reset();
    if (run.damped && converged(session) && !solving(session)) {
      motion.settled = find_settled(run, session.answer.solution);
      motion.nearly_settled = nearly_settled(run, *motion.settled, session.answer.solution);
      if (shown->rests_in && runs_into(run, session.answer.solution, *shown->rests_in))
        motion.elsewhere = shown->rests_in;
    }
  }
}

void advance_motion(Session& session, double seconds) {
  const MotionRun* shown = shown_motion(session);
  if (!shown) return;
  const std::vector<double>& times = shown->run->time;
  double time = session.playback.time + seconds;
  if (time >= times.back()) {
    time = times.back();
    if (shown->finished) { // else what is still being computed is waited for
      if (session.motion.loop && times.back() > times.front())
        time = times.front();
      else
        session.playback.playing = false;
    }
  }
  seek_motion(session, time);
}

void seek_motion(Session& session, double time) {
  if (const MotionRun* shown = shown_motion(session))
    time = std::clamp(time, shown->run->time.front(), shown->run->time.back());
  session.playback.time = time;
  session.moved_time = true;
}

void step_motion(Session& session, int samples) {
  const MotionRun* shown = shown_motion(session);
  if (!shown) return;
  session.playback.playing = false;
  const std::vector<double>& times = shown->run->time;
  const std::size_t now = sample_before(*shown->run, session.playback.time);
  // From between two samples, back means to the one before.
  const bool between = now + 1 < times.size() &&
                       session.playback.time - times[now] > same_sample * (times[now + 1] - times[now]);
  const long to = std::clamp(static_cast<long>(now) + samples + (samples < 0 && between ? 1 : 0), 0L,
                             static_cast<long>(times.size()) - 1);
  seek_motion(session, times[static_cast<std::size_t>(to)]);
}

double steady_time(const Session& session) {
  const MotionRun* shown = session.motion.on ? shown_motion(session) : nullptr;
  return shown && session.answer.mechanism
             ? steady_time(*shown->run, *session.answer.mechanism, session.playback.time)
             : session.playback.time;
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

void keep_motion_state(Session& session) {
  const MotionRun* shown = shown_motion(session);
  if (!shown) return;
  session.motion.saved = state_at(*shown->run, sample_before(*shown->run, session.playback.time));
  session.notice = "The state of the motion is kept to start from.";
}

} // namespace flyball
