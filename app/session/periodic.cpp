#include "app/session/periodic.hpp"

#include "app/session/session.hpp"
#include "engine/periodic/limit_cycle.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

PeriodicState find_motion(const PeriodicRequest& request, const TaskContext<PeriodicState>& context) {
  PeriodicOptions options;
  options.cancel = &context.cancel;
  options.progress = context.progress;
  return find_periodic_state(*request.mechanism, options);
}

std::optional<PeriodicRequest> periodic_request(const Session& session) {
  const LiveAnswer& answer = session.answer;
  if (!answer.mechanism || answer.error || answer.solution.status != Status::no_steady_state)
    return std::nullopt;
  return PeriodicRequest{{answer.mechanism}};
}

PeriodicState find_cycle_of(const PeriodicRequest& request, const TaskContext<PeriodicState>& context) {
  return find_limit_cycle(*request.mechanism, &context.cancel, context.progress);
}

std::optional<PeriodicRequest> cycle_request(const Session& session) {
  if (!session.study.periodic.cycle_wanted || !may_cycle(session)) return std::nullopt;
  return PeriodicRequest{{session.answer.mechanism}};
}

void update_cycle(Session& session) {
  auto& cycle = session.study.periodic.cycle;
  const auto wanted = cycle_request(session);
  if (!wanted) {
    // While another state is solved for it stays as it is.
    if (cycle.asked && !(session.study.periodic.cycle_wanted && solving(session))) cycle = {};
    return;
  }
  cycle.take();
  if (cycle.asked == *wanted) return;
  cycle.ask(session.options, *wanted, find_cycle_of,
            cycle.quick() ? BackgroundWorker::Running::finished : BackgroundWorker::Running::cancelled);
  cycle.take();
}

// Where the motion is now; session.poses are of no steady state.
void pose_motion(Session& session) {
  const PeriodicState* motion = periodic_motion(session);
  if (!motion) {
    if (session.study.periodic.posed.motion) session.poses.clear();
    session.study.periodic.posed = {};
    return;
  }
  const PeriodicStudy::Posed now{motion->motion, std::fmod(steady_time(session), motion->period)};
  if (now == session.study.periodic.posed && !session.poses.empty()) return;
  session.poses = poses_at(*now.motion, now.time < 0 ? now.time + motion->period : now.time);
  session.study.periodic.posed = now;
  // That of an earlier answer may have had other bodies.
  if (session.poses.size() != session.answer.mechanism->bodies.size()) session.poses.clear();
}

} // namespace

void update_periodic(Session& session) {
  update_cycle(session);
  auto& search = session.study.periodic.search;
  const auto wanted = periodic_request(session);
  if (!wanted) {
    if (!search.asked) return;
    search = {};
    session.study.periodic.posed = {}; // the poses are the steady state's again
    return;
  }
  search.take();
  if (search.asked != *wanted) {
    search.ask(session.options, *wanted, find_motion,
               search.quick() ? BackgroundWorker::Running::finished : BackgroundWorker::Running::cancelled);
    search.take();
  }
  pose_motion(session);
}

const PeriodicState* periodic_state(const Session& session) {
  const auto& search = session.study.periodic.search;
  const auto wanted = periodic_request(session);
  if (!wanted || !search.found || (!search.running() && !search.is_of(*wanted))) return nullptr;
  return &search.found->result;
}

const PeriodicState* periodic_motion(const Session& session) {
  const PeriodicState* state = periodic_state(session);
  return state && state->status == PeriodicStatus::found ? state : nullptr;
}

void show_periodic_motion(Session& session, const PeriodicState& state) {
  session.motion.saved = state.start;
  session.motion.start = Start::state;
  session.motion.duration = 2 * state.period;
  if (session.study.open == StudyKind::motion && session.motion.on)
    restart_motion(session);
  else
    open_study(session, StudyKind::motion);
}

bool hunts(const Session& session) {
  return converged(session) && session.answer.mechanism && hunts(session.answer.solution);
}

bool may_cycle(const Session& session) {
  const LiveAnswer& answer = session.answer;
  if (!answer.mechanism || answer.error) return false;
  if (answer.solution.status != Status::not_converged) return hunts(session);
  return std::ranges::any_of(answer.mechanism->joints, [](const Joint& joint) {
    return std::ranges::any_of(joint.coordinates,
                               [](const Coordinate& c) { return c.drive && c.drive->torque; });
  });
}

void find_cycle(Session& session, bool wanted) {
  session.study.periodic.cycle_wanted = wanted;
  if (!wanted) session.study.periodic.cycle = {};
}

const PeriodicState* limit_cycle(const Session& session) {
  const auto& cycle = session.study.periodic.cycle;
  const auto wanted = cycle_request(session);
  if (!wanted || !cycle.found || (!cycle.running() && !cycle.is_of(*wanted))) return nullptr;
  return &cycle.found->result;
}

const PeriodicState* cycle_instead(const Session& session) {
  if (converged(session) || periodic_motion(session)) return nullptr;
  const PeriodicState* cycle = limit_cycle(session);
  return cycle && cycle->status == PeriodicStatus::found ? cycle : nullptr;
}

} // namespace flyball
