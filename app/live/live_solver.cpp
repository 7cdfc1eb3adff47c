#include "app/live/live_solver.hpp"

#include <exception>
#include <utility>

namespace flyball {

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
    }
    if (analysis_)
      analysis_->update(job.request.mechanism);
    else
      analysis_.emplace(job.request.mechanism);
    SolveOptions options;
    options.warm = job.request.warm;
    options.nearest = job.request.nearest;
    options.cancel = &cancel_;
    answer.solution = analysis_->solve(options);
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

LivePoses LiveSolver::poses_at(double time) const {
  return {analysed_, time, analysis_->poses_at(time)};
}

} // namespace flyball
