#include "app/live/live_solver.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <utility>

namespace flyball {

namespace {

// Whether Newton-Raphson has thrown an angle so far that it is another branch's.
bool moved_far(const std::vector<std::pair<std::string, double>>& start, const Solution& found) {
  constexpr double far = 0.8; // rad
  for (const CoordinateSolution& c : found.coordinates) {
    if (c.driven || !c.angle) continue;
    const std::string name = coordinate_label(c);
    for (const auto& [joint, value] : start)
      if (joint == name && std::abs(std::remainder(c.value - value, 2 * std::numbers::pi)) > far) return true;
  }
  return false;
}

} // namespace

// The mechanism as it was last solved. Used by one thread at a time.
class LiveSolver::Solver {
 public:
  LiveAnswer solve(std::uint64_t ticket, const LiveRequest& request, const Wishes& wishes,
                   const std::atomic<bool>& cancel);
  LivePoses poses_at(double time);

 private:
  Solution solve_nearest(SolveOptions options, bool& left_branch);
  void forget() {
    analysis_.reset();
    settled_ = 0;
  }

  std::mutex mutex_; // guards all below
  std::optional<Analysis> analysis_;
  std::uint64_t answered_ = 0; // ticket of the last request that was not cancelled
  std::uint64_t settled_ = 0;  // the same where there is a steady state; 0: no poses to be had
  std::vector<std::pair<std::string, double>> last_; // free coordinates of the last steady state
};

LiveSolver::LiveSolver(Mode mode, const std::function<void()>& on_news)
    : solver_(std::make_shared<Solver>()), answers_(mode, on_news), poses_(mode, on_news) {}

std::uint64_t LiveSolver::ask(LiveRequest request) {
  using Running = Background<LiveAnswer>::Running;
  const std::uint64_t ticket = ++tickets_;
  if (request.another) wishes_.another = ticket;
  if (!request.warm) wishes_.cold = ticket;
  // Where a hand has put it, it starts also when a slider moves before that was solved.
  if (!request.start.empty() || !request.nearest || !request.warm) {
    wishes_.started = ticket;
    wishes_.start = request.start;
  }
  const Running running = request.another ? Running::cancelled : Running::alternating;
  answers_.start(
      [solver = solver_, ticket, request = std::move(request),
       wishes = wishes_](const TaskContext<LiveAnswer>& context) {
        return solver->solve(ticket, request, wishes, context.cancel);
      },
      running);
  return ticket;
}

void LiveSolver::ask_poses(double time) {
  poses_.start([solver = solver_, time](const auto&) { return solver->poses_at(time); },
               Background<LivePoses>::Running::finished);
}

std::optional<LiveAnswer> LiveSolver::take_answer() {
  if (const auto news = answers_.take(); news && news->result) return std::move(*news->result);
  return std::nullopt;
}

std::optional<LivePoses> LiveSolver::take_poses() {
  if (const auto news = poses_.take(); news && news->result && news->result->ticket)
    return std::move(*news->result);
  return std::nullopt;
}

LiveAnswer LiveSolver::Solver::solve(std::uint64_t ticket, const LiveRequest& request, const Wishes& wishes,
                                     const std::atomic<bool>& cancel) {
  const std::lock_guard lock(mutex_);
  LiveAnswer out;
  out.ticket = ticket;
  out.mechanism = request.mechanism;
  out.time = request.time;
  bool solved = false;
  try {
    if (wishes.another > answered_) {
      forget();
      last_.clear();
    }
    if (analysis_)
      analysis_->update(request.mechanism);
    else
      analysis_.emplace(request.mechanism);
    SolveOptions options;
    options.cancel = &cancel;
    options.warm = wishes.cold <= answered_;
    options.nearest = request.nearest;
    if (wishes.started > answered_) options.start = wishes.start;
    options.points = request.points;
    out.solution = solve_nearest(options, out.left_branch);
    settled_ = out.solution.status == Status::converged ? ticket : 0;
    solved = true;
    out.summary = analysis_->summary();
    if (settled_) {
      last_ = start_values(out.solution.coordinates);
      if (request.grip) out.grip = find_grip(*out.mechanism, out.solution, *request.grip);
      out.poses = out.time == 0 ? out.solution.poses : analysis_->poses_at(out.time);
      out.turning = analysis_->turning_at(0);
    }
  } catch (const Interrupted&) { // nobody waits for it; what comes after solving leaves the state as it is
    out.solution = {};
    if (!solved) forget();
  } catch (const SceneError& error) {
    out.error = error;
    out.solution = {};
    forget();
  } catch (const std::exception& error) { // no memory
    out.error = SceneError("", error.what());
    out.solution = {};
    forget();
  }
  if (!cancel) answered_ = ticket;
  return out;
}

Solution LiveSolver::Solver::solve_nearest(SolveOptions options, bool& left_branch) {
  // Analysis goes back to the drawn pose from a state that is no minimum; a branch is followed through those.
  if (options.nearest && options.warm && options.start.empty()) options.start = last_;
  Solution found = analysis_->solve(options);
  left_branch = options.nearest && !options.start.empty() && !is_cancelled(options.cancel) &&
                (found.status != Status::converged || found.fallback || moved_far(options.start, found));
  if (!left_branch) return found;
  options.nearest = options.warm = false;
  options.start.clear();
  return analysis_->solve(options);
}

LivePoses LiveSolver::Solver::poses_at(double time) {
  const std::lock_guard lock(mutex_);
  if (!settled_) return {};
  return {settled_, time, analysis_->poses_at(time)};
}

} // namespace flyball
