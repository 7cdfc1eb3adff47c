// One long computation at a time on a thread of its own, with progress, that can be cancelled. The newest
// task wins.
#pragma once

#include "app/live/live_solver.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace flyball {

template <class Result>
class Background {
 public:
  // What a task is given to look at and to tell: `cancel` becomes true when the result is not wanted any
  // more; progress from 0 to 1.
  struct Watch {
    const std::atomic<bool>& cancel;
    std::function<void(double)> progress;
  };
  using Task = std::function<Result(const Watch&)>;

  // As of a LiveSolver.
  explicit Background(LiveSolver::Mode mode, std::function<void()> on_news = {})
      : mode_(mode), on_news_(std::move(on_news)) {}
  ~Background() {
    thread_.request_stop();
    const std::lock_guard lock(mutex_);
    cancel_ = true;
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  // What the task throws becomes the problem. A task that has not begun is replaced. One that runs is
  // cancelled and its result dropped, unless `after` it is wanted: then it is finished and taken first, so
  // that something new is seen however often a hand asks.
  void start(Task task, bool after = false) {
    std::unique_lock lock(mutex_);
    ++wanted_;
    if (!after) dropped_ = wanted_ - 1;
    if (mode_ == LiveSolver::Mode::immediate) {
      lock.unlock();
      run(task, wanted_);
      return;
    }
    if (!after) cancel_ = true;
    next_ = std::move(task);
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
    lock.unlock();
    wake_.notify_one();
  }
  // The result comes all the same, of what was done until then, if the task gives one.
  void cancel() {
    const std::lock_guard lock(mutex_);
    cancel_ = true;
    cancelled_ = wanted_; // also if it has not begun
  }

  // The newest result or problem, once.
  struct News {
    std::optional<Result> result;
    std::string problem;
  };
  std::optional<News> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, std::nullopt);
  }
  // Whether an answer to the newest task is still to come.
  bool running() const {
    const std::lock_guard lock(mutex_);
    return done_ < wanted_;
  }
  double progress() const { return progress_; }

 private:
  void work(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (wake_.wait(lock, stop, [this] { return next_.has_value(); })) {
      if (stop.stop_requested()) return;
      const Task task = *std::exchange(next_, std::nullopt);
      const std::uint64_t ticket = wanted_;
      cancel_ = stop.stop_requested() || ticket <= cancelled_;
      lock.unlock();
      run(task, ticket);
      lock.lock();
    }
  }

  void run(const Task& task, std::uint64_t ticket) {
    progress_ = 0;
    News news;
    try {
      news.result = task(Watch{cancel_, [this](double part) { progress_ = std::clamp(part, 0., 1.); }});
    } catch (const std::exception& error) {
      news.problem = error.what();
    }
    {
      const std::lock_guard lock(mutex_);
      if (ticket <= dropped_) return;
      done_ = ticket;
      news_ = std::move(news);
    }
    if (on_news_) on_news_();
  }

  std::atomic<bool> cancel_{false};
  std::atomic<double> progress_{0};
  const LiveSolver::Mode mode_;
  const std::function<void()> on_news_;

  mutable std::mutex mutex_; // guards all below
  std::condition_variable_any wake_;
  std::uint64_t wanted_ = 0, done_ = 0, dropped_ = 0, cancelled_ = 0; // tasks, counted from 1
  std::optional<Task> next_;
  std::optional<News> news_;

  std::jthread thread_; // made with the first task; last, so that it ends before what it uses
};

} // namespace flyball
