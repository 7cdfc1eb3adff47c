#include "app/live/live_solver.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>
#include <exception>
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

struct LiveSolver::State {
  struct Job {
    std::uint64_t ticket = 0;
    LiveRequest request;
  };

  State(Mode chosen, std::function<void()> news) : mode(chosen), on_news(std::move(news)) {}

  void work(const std::stop_token& stop);
  LiveAnswer solve(const Job& job);
  LivePoses poses_at(double time);
  Solution solve_nearest(const LiveRequest& request, bool& left_branch);

  // Used by whoever solves: the background thread, or the caller in immediate mode.
  std::optional<Analysis> analysis;
  std::uint64_t analysed = 0; // ticket of the last answer with a solution; 0: no poses to be had
  std::vector<std::pair<std::string, double>> last; // free coordinates of the last steady state
  std::atomic<bool> cancel{false};

  const Mode mode;
  Callback on_news;

  std::mutex mutex; // guards all below
  std::condition_variable_any wake;
  std::uint64_t tickets = 0, answered = 0;
  bool running = false, spare = false; // spare: what runs follows a cancelled solve
  std::optional<Job> next;
  std::vector<std::pair<std::string, double>> running_start; // of what runs
  std::optional<double> next_time;
  std::optional<LiveAnswer> answer;
  std::optional<LivePoses> poses;
};

LiveSolver::LiveSolver(Mode mode, std::function<void()> on_news)
    : state_(std::make_shared<State>(mode, std::move(on_news))) {
  if (mode == Mode::background)
    thread_ = Worker([state = state_](const std::stop_token& stop) { state->work(stop); });
}

LiveSolver::~LiveSolver() {
  state_->on_news.silence();
  const std::lock_guard lock(state_->mutex);
  state_->cancel = true;
  state_->next.reset();
}

std::uint64_t LiveSolver::ask(LiveRequest request) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  State::Job job{++s.tickets, std::move(request)};
  if (s.mode == Mode::immediate) {
    s.answer = s.solve(job);
    s.answered = job.ticket;
    return job.ticket;
  }
  if (s.next && s.next->request.another) job.request.another = true;
  if (s.next && !s.next->request.warm) job.request.warm = false;
  // Where a hand has put it, it starts also when a slider moves before that was solved.
  LiveRequest& wanted = job.request;
  if (wanted.nearest && wanted.warm && wanted.start.empty()) {
    if (s.next && s.next->request.nearest)
      wanted.start = s.next->request.start;
    else if (!s.next && s.running && !s.spare) // it is cancelled below
      wanted.start = s.running_start;
  }
  if (job.request.another) {
    s.answer.reset();
    s.poses.reset();
    s.next_time.reset();
  }
  if (s.running && (job.request.another || !s.spare)) s.cancel = true;
  const std::uint64_t ticket = job.ticket;
  s.next = std::move(job);
  lock.unlock();
  s.wake.notify_one();
  return ticket;
}

void LiveSolver::ask_poses(double time) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  if (s.mode == Mode::immediate) {
    if (s.analysed) s.poses = s.poses_at(time);
    return;
  }
  s.next_time = time;
  lock.unlock();
  s.wake.notify_one();
}

std::optional<LiveAnswer> LiveSolver::take_answer() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->answer, std::nullopt);
}

std::optional<LivePoses> LiveSolver::take_poses() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->poses, std::nullopt);
}

bool LiveSolver::busy() const {
  const std::lock_guard lock(state_->mutex);
  return state_->answered < state_->tickets;
}

void LiveSolver::State::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex);
  while (wake.wait(lock, stop, [this] { return next || next_time; })) {
    if (stop.stop_requested()) return;
    if (next) {
      const Job job = *std::exchange(next, std::nullopt);
      cancel = stop.stop_requested();
      running = true;
      running_start = job.request.start;
      lock.unlock();
      LiveAnswer found = solve(job);
      lock.lock();
      running = false;
      spare = cancel && !stop.stop_requested();
      if (cancel) continue;
      answered = job.ticket;
      answer = std::move(found);
    } else {
      const double time = *std::exchange(next_time, std::nullopt);
      if (!analysed) continue;
      lock.unlock();
      LivePoses found = poses_at(time);
      lock.lock();
      poses = std::move(found);
    }
    lock.unlock();
    on_news();
    lock.lock();
  }
}

LiveAnswer LiveSolver::State::solve(const Job& job) {
  const Interruptible scope(&cancel);
  LiveAnswer out;
  out.ticket = job.ticket;
  out.mechanism = job.request.mechanism;
  out.time = job.request.time;
  try {
    if (job.request.another) {
      analysis.reset();
      analysed = 0;
      last.clear();
    }
    if (analysis)
      analysis->update(job.request.mechanism);
    else
      analysis.emplace(job.request.mechanism);
    out.solution = solve_nearest(job.request, out.left_branch);
    if (out.solution.status == Status::converged) last = start_values(out.solution.coordinates);
    out.summary = analysis->summary();
    analysed = out.solution.status == Status::converged ? job.ticket : 0;
    if (analysed && job.request.grip) out.grip = find_grip(*out.mechanism, out.solution, *job.request.grip);
    if (analysed) {
      out.poses = out.time == 0 ? out.solution.poses : analysis->poses_at(out.time);
      out.turning = analysis->turning_at(0);
    }
  } catch (const std::exception& error) { // SceneError, or no memory
    out.error = error.what();
    out.solution = {};
    analysis.reset();
    analysed = 0;
  }
  return out;
}

Solution LiveSolver::State::solve_nearest(const LiveRequest& request, bool& left_branch) {
  SolveOptions options;
  options.cancel = &cancel;
  options.warm = request.warm;
  options.nearest = request.nearest;
  options.start = request.start;
  options.points = request.points;
  // Analysis goes back to the drawn pose from a state that is no minimum; a branch is followed through those.
  if (request.nearest && request.warm && request.start.empty()) options.start = last;
  Solution found = analysis->solve(options);
  left_branch = request.nearest && !options.start.empty() && !cancel &&
                (found.status != Status::converged || found.fallback || moved_far(options.start, found));
  if (!left_branch) return found;
  options.nearest = options.warm = false;
  options.start.clear();
  return analysis->solve(options);
}

LivePoses LiveSolver::State::poses_at(double time) {
  return {analysed, time, analysis->poses_at(time)};
}

} // namespace flyball
