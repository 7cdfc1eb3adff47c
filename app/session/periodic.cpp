#include "app/session/periodic.hpp"

#include "app/session/session.hpp"

#include <cmath>

namespace flyball {
namespace {

PeriodicState find_motion(const PeriodicRequest& request, const TaskContext<PeriodicState>& context) {
  PeriodicOptions options;
  options.cancel = &context.cancel;
  return find_periodic_state(*request.mechanism, options);
}

std::optional<PeriodicRequest> periodic_request(const Session& session) {
  const LiveAnswer& answer = session.answer;
  if (!answer.mechanism || answer.error || answer.solution.status != Status::no_steady_state)
    return std::nullopt;
  return PeriodicRequest{{answer.mechanism}};
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
  auto& search = session.study.periodic.search;
  const auto wanted = periodic_request(session);
  if (!wanted) {
    if (search.asked) session.study.periodic = {}; // the poses are the steady state's again
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

void show_periodic_motion(Session& session) {
  const PeriodicState* state = periodic_motion(session);
  if (!state) return;
  session.motion.saved = state->start;
  session.motion.start = Start::state;
  if (session.study.open == StudyKind::motion && session.motion.on)
    restart_motion(session);
  else
    open_study(session, StudyKind::motion);
}

} // namespace flyball
