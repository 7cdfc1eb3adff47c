#include "app/live/live_solver.hpp"
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

LiveSolver::LiveSolver(Mode mode, std::function<void()> on_news) : mode_(mode), on_news_(std::move(on_news)) {
  if (mode_ == Mode::background) thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

LiveSolver::~LiveSolver() {
  thread_.request_stop();
  const std::lock_guard lock(mutex_);
  cancel_ = true;
}

std::uint64_t LiveSolver::ask(LiveRequest request) {
  std::unique_lock lock(mutex_);
  Job job{++tickets_, std::move(request)};
  if (mode_ == Mode::immediate) {
    answer_ = solve(job);
    answered_ = job.ticket;
    return job.ticket;
  }
  if (next_ && next_->request.another) job.request.another = true;
  if (next_ && !next_->request.warm) job.request.warm = false;
  // Where a hand has put it, it starts also when a slider moves before that was solved.
  LiveRequest& wanted = job.request;
  if (wanted.nearest && wanted.warm && wanted.start.empty()) {
    if (next_ && next_->request.nearest)
      wanted.start = next_->request.start;
    else if (!next_ && running_ && !spare_) // it is cancelled below
      wanted.start = running_start_;
  }
  if (job.request.another) {
    answer_.reset();
    poses_.reset();
    next_time_.reset();
  }
  if (running_ && (job.request.another || !spare_)) cancel_ = true;
  const std::uint64_t ticket = job.ticket;
  next_ = std::move(job);
  lock.unlock();
  wake_.notify_one();
  return ticket;
}

void LiveSolver::ask_poses(double time) {
  std::unique_lock lock(mutex_);
  if (mode_ == Mode::immediate) {
    if (analysed_) poses_ = poses_at(time);
    return;
  }
  next_time_ = time;
  lock.unlock();
  wake_.notify_one();
}

std::optional<LiveAnswer> LiveSolver::take_answer() {
  const std::lock_guard lock(mutex_);
  return std::exchange(answer_, std::nullopt);
}

std::optional<LivePoses> LiveSolver::take_poses() {
  const std::lock_guard lock(mutex_);
  return std::exchange(poses_, std::nullopt);
}

bool LiveSolver::busy() const {
  const std::lock_guard lock(mutex_);
  return answered_ < tickets_;
}

void LiveSolver::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return next_ || next_time_; })) {
    if (stop.stop_requested()) return;
    if (next_) {
      const Job job = *std::exchange(next_, std::nullopt);
      cancel_ = stop.stop_requested();
      running_ = true;
      running_start_ = job.request.start;
      lock.unlock();
      LiveAnswer answer = solve(job);
      lock.lock();
      running_ = false;
      spare_ = cancel_ && !stop.stop_requested();
      if (cancel_) continue;
      answered_ = job.ticket;
      answer_ = std::move(answer);
    } else {
      const double time = *std::exchange(next_time_, std::nullopt);
      if (!analysed_) continue;
      lock.unlock();
      LivePoses poses = poses_at(time);
      lock.lock();
      poses_ = std::move(poses);
    }
    if (on_news_) {
      lock.unlock();
      on_news_();
      lock.lock();
    }
  }
}

LiveAnswer LiveSolver::solve(const Job& job) {
  LiveAnswer answer;
  answer.ticket = job.ticket;
  answer.mechanism = job.request.mechanism;
  answer.time = job.request.time;
  try {
    if (job.request.another) {
      analysis_.reset();
      analysed_ = 0;
      last_.clear();
    }
    if (analysis_)
      analysis_->update(job.request.mechanism);
    else
      analysis_.emplace(job.request.mechanism);
    answer.solution = solve_nearest(job.request, answer.left_branch);
    if (answer.solution.status == Status::converged) last_ = start_values(answer.solution.coordinates);
    answer.summary = analysis_->summary();
    analysed_ = answer.solution.status == Status::converged ? job.ticket : 0;
    if (analysed_) answer.poses = answer.time == 0 ? answer.solution.poses : analysis_->poses_at(answer.time);
  } catch (const std::exception& error) { // SceneError, or no memory
    answer.error = error.what();
    answer.solution = {};
    analysis_.reset();
    analysed_ = 0;
  }
  return answer;
}

Solution LiveSolver::solve_nearest(const LiveRequest& request, bool& left_branch) {
  SolveOptions options;
  options.cancel = &cancel_;
  options.warm = request.warm;
  options.nearest = request.nearest;
  options.start = request.start;
  // Analysis goes back to the drawn pose from a state that is no minimum; a branch is followed through those.
  if (request.nearest && request.warm && request.start.empty()) options.start = last_;
  Solution found = analysis_->solve(options);
  left_branch = request.nearest && !options.start.empty() && !cancel_ &&
                (found.status != Status::converged || found.net || moved_far(options.start, found));
  if (!left_branch) return found;
  options.nearest = options.warm = false;
  options.start.clear();
  return analysis_->solve(options);
}

LivePoses LiveSolver::poses_at(double time) const {
  return {analysed_, time, analysis_->poses_at(time)};
}

} // namespace flyball
