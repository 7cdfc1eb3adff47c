#include "app/live/motion.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

namespace flyball {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double slice = 0.02; // s of computing between looks at what else is wanted
constexpr double apart = 0.04; // s between two pieces of news, at least
constexpr double share = 10;   // copying the run must take no more than one part in so many of the time

constexpr std::size_t least_samples = 5000; // whatever memory they take

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

std::size_t memory_of(const Run& run) {
  std::size_t bytes = 0;
  const auto add = [&](const auto&... lists) { ((bytes += lists.size() * sizeof(lists[0])), ...); };
  add(run.time, run.states, run.energy.kinetic, run.energy.potential, run.energy.jacobi,
      run.energy.dissipated, run.energy.delivered, run.energy.applied, run.energy.balance, run.stops,
      run.frictions);
  for (const CoordinateTrack& track : run.coordinates)
    add(track.value, track.rate);
  for (const DriveTrack& track : run.drives)
    add(track.torque, track.load);
  for (const ReactionTrack& track : run.reactions)
    add(track.force, track.torque);
  for (const BearingTrack& track : run.bearings)
    add(track.force, track.torque);
  for (const GearTrack& track : run.gears)
    add(track.a, track.b);
  for (const SpringTrack& track : run.springs)
    add(track.spring, track.damper, track.stop);
  for (const PointTrack& track : run.points)
    add(track.position, track.velocity, track.acceleration);
  for (const MeasureTrack& track : run.measures)
    add(track.value);
  return bytes;
}

std::shared_ptr<const Solution> resting_state(const Run& run,
                                              const std::shared_ptr<const Mechanism>& mechanism,
                                              const std::atomic<bool>* cancel) {
  constexpr double still = 0.1; // of a radian or the reach, in the run's last tenth
  if (!run.damped || run.time.size() < 2) return nullptr;
  const std::size_t last = run.time.size() - 1, first = last - last / 10;
  try {
    SolveOptions options;
    options.details = options.explain = false;
    options.search = 0;
    options.newton_only = true; // from so near
    options.cancel = cancel;
    for (const CoordinateTrack& track : run.coordinates) {
      if (track.driven || track.dependent) continue;
      if (!(std::abs(track.value[first] - track.value[last]) < still * track.scale)) return nullptr;
      options.start.emplace_back(coordinate_label(track), track.value[last]);
    }
    return std::make_shared<const Solution>(Analysis(mechanism).solve(options));
  } catch (const std::exception&) { // SceneError, or no memory: the run goes without
    return nullptr;
  }
}

Motion compute_motion(const MotionRequest& request, const TaskContext<Motion>& context) {
  // The simulator looks at the flag by itself, and keeps what it has; nothing is thrown away by others.
  const Uninterrupted scope;
  SimulationOptions options = request.options;
  options.cancel = &context.cancel;
  std::shared_ptr<const Run> before = request.before;
  std::size_t last = 0;
  double duration = options.duration;
  try {
    if (before && before->time.empty()) before = nullptr;
    if (before) {
      last = sample_before(*before, request.time);
      duration -= before->time[last] - before->time.front();
      options.start = Start::state;
      options.state = state_at(*before, last);
    }
    Simulator simulator(*request.mechanism, options);
    if (simulator.run().time.empty()) // cancelled before it began
      return {before, true, simulator.run().message, {}};
    const double begin = simulator.time(), end = begin + std::max(duration, 0.);
    const auto so_far = [&] {
      return std::make_shared<const Run>(before ? joined(*before, last, simulator.run()) : simulator.run());
    };
    double step = options.rate > 0 ? 1 / options.rate : end - begin, wait = apart;
    auto told = Clock::now();
    bool well = true;
    for (double until = begin; well && until < end;) {
      const auto started = Clock::now();
      until = std::min(end, until + step);
      well = simulator.advance(until, until == end);
      const double took = since(started);
      const std::size_t samples = simulator.run().time.size() + last;
      if (well && until < end && samples > least_samples &&
          memory_of(simulator.run()) / simulator.run().time.size() * samples > request.most_memory)
        return {so_far(),
                true,
                "The run is kept up to " + rounded_text(simulator.run().time.back(), 6) +
                    " s: more of it would take too much memory. Keep its last state to start from there.",
                {}};
      if (options.rate > 0) step *= std::clamp(slice / std::max(took, 1e-6), 0.5, 2.);
      if (well && until < end && since(told) > wait) {
        const auto copying = Clock::now();
        context.publish({so_far(), false, {}, {}});
        wait = std::max(apart, share * since(copying));
        told = Clock::now();
      }
    }
    Motion motion{so_far(), true, {}, {}};
    context.publish({motion.run, false, {}, {}}); // there already while that is solved for
    motion.rests_in = resting_state(*motion.run, request.mechanism, &context.cancel);
    return motion;
  } catch (const std::exception& error) { // SceneError, or no memory
    return {before, true, error.what(), {}};
  }
}

} // namespace flyball
