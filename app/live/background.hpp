// One long computation at a time on a thread of its own, with progress, that can be cancelled. The newest
// task wins, and nobody waits for one that is no longer wanted.
#pragma once

#include "app/live/live_solver.hpp"
#include "app/live/worker.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/task/progress.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace flyball {

template <class Result>
class Background {
 public:
  // What a task is given to look at and to report to: `cancel` becomes true when the result is not wanted any
  // more.
  struct Watch {
    const std::atomic<bool>& cancel;
    ReportProgress progress;
  };
  // Must own what it uses: it goes on for a moment when this object is gone.
  using Task = std::function<Result(const Watch&)>;

  // As of a LiveSolver.
  explicit Background(LiveSolver::Mode mode, std::function<void()> on_news = {})
      : state_(std::make_shared<State>(mode, std::move(on_news))) {}
  ~Background() {
    state_->on_news.silence();
    const std::lock_guard lock(state_->mutex);
    state_->cancel = state_->ended = true;
    state_->next.reset();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  // What the task throws becomes the problem. A task that has not begun is replaced. One that runs is
  // cancelled and its result dropped, unless `after` it is wanted: then it is finished and taken first, so
  // that something new is seen however often a hand asks.
  void start(Task task, bool after = false) {
    State& s = *state_;
    std::unique_lock lock(s.mutex);
    ++s.wanted;
    if (!after) s.dropped = s.wanted - 1;
    if (s.mode == LiveSolver::Mode::immediate) {
      const std::uint64_t ticket = s.wanted;
      s.cancel = false;
      lock.unlock();
      s.run(task, ticket);
      return;
    }
    if (!after) s.cancel = true;
    s.next = std::move(task);
    if (!thread_.started())
      thread_ = Worker([state = state_](const std::stop_token& stop) { state->work(stop); });
    lock.unlock();
    s.wake.notify_one();
  }
  // The result comes all the same, of what was done until then, if the task gives one.
  void cancel() {
    const std::lock_guard lock(state_->mutex);
    state_->cancel = true;
    state_->cancelled = state_->wanted; // also if it has not begun
  }

  // The newest result or problem, once.
  struct News {
    std::optional<Result> result;
    std::string problem;
  };
  std::optional<News> take() {
    const std::lock_guard lock(state_->mutex);
    return std::exchange(state_->news, std::nullopt);
  }
  // Whether an answer to the newest task is still to come.
  bool running() const {
    const std::lock_guard lock(state_->mutex);
    return state_->done < state_->wanted;
  }
  // Of the task that runs, or ran last; `part` is 0 until something is reported.
  Progress progress() const { return {state_->phase, state_->part}; }
  // How long that has run, s.
  double seconds() const {
    return std::chrono::duration<double>(Clock::now() - state_->begun.load()).count();
  }

 private:
  using Clock = std::chrono::steady_clock;

  // What the thread uses. It shares in owning it, and so may come to its end later than the rest.
  struct State {
    State(LiveSolver::Mode chosen, std::function<void()> news_callback)
        : mode(chosen), on_news(std::move(news_callback)) {}

    void work(const std::stop_token& stop) {
      std::unique_lock lock(mutex);
      while (wake.wait(lock, stop, [this] { return next.has_value(); })) {
        if (stop.stop_requested()) return;
        const Task task = *std::exchange(next, std::nullopt);
        const std::uint64_t ticket = wanted;
        cancel = ended || ticket <= cancelled;
        lock.unlock();
        run(task, ticket);
        lock.lock();
      }
    }

    void run(const Task& task, std::uint64_t ticket) {
      part = 0;
      phase = "";
      begun = Clock::now();
      News fresh;
      const Interruptible scope(&cancel);
      try {
        fresh.result = task(Watch{cancel, [this](const Progress& now) {
                                    phase = now.phase;
                                    if (now.part >= 0) part = std::min(now.part, 1.);
                                  }});
      } catch (const std::exception& error) {
        fresh.problem = error.what();
      }
      {
        const std::lock_guard lock(mutex);
        if (ended || ticket <= dropped) return;
        done = ticket;
        news = std::move(fresh);
      }
      on_news();
    }

    std::atomic<bool> cancel{false};
    std::atomic<double> part{0};
    std::atomic<const char*> phase{""};
    std::atomic<Clock::time_point> begun{Clock::now()};
    const LiveSolver::Mode mode;
    Callback on_news;

    std::mutex mutex; // guards all below
    std::condition_variable_any wake;
    std::uint64_t wanted = 0, done = 0, dropped = 0, cancelled = 0; // tasks, counted from 1
    bool ended = false;                                             // nobody is there to take anything
    std::optional<Task> next;
    std::optional<News> news;
  };

  std::shared_ptr<State> state_;
  Worker thread_; // made with the first task
};

} // namespace flyball
