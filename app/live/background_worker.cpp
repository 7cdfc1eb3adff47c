#include "app/live/background_worker.hpp"

#include "engine/linear/interruption.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <utility>

namespace flyball {

using Clock = std::chrono::steady_clock;

struct BackgroundWorker::State {
  State(Mode chosen, std::function<void()> callback) : mode(chosen), on_news(std::move(callback)) {}

  void work(const std::stop_token& stop);
  void run(const Task& task, std::uint64_t ticket);
  void deliver(std::uint64_t ticket, News fresh, bool last);

  const Mode mode;
  Callback on_news;
  std::atomic<bool> cancel{false};
  std::atomic<double> part{0};
  std::atomic<const char*> phase{""};
  std::atomic<Clock::time_point> begun{Clock::now()};

  std::mutex mutex; // guards all below
  std::condition_variable_any wake;
  // Tasks, counted from 1: how many there were; up to which they are answered, not to be taken any more, and
  // to be stopped, also where they have not begun.
  std::uint64_t wanted = 0, done = 0, dropped = 0, stopped = 0;
  bool busy = false, spared = false; // spared: what runs follows a cancelled task
  bool ended = false;                // nobody is there to take anything
  std::optional<Task> next;
  std::optional<News> news;
};

BackgroundWorker::BackgroundWorker(Mode mode, std::function<void()> on_news)
    : state_(std::make_shared<State>(mode, std::move(on_news))) {}

BackgroundWorker::~BackgroundWorker() {
  state_->on_news.silence();
  const std::lock_guard lock(state_->mutex);
  state_->cancel = state_->ended = true;
  state_->next.reset();
}

void BackgroundWorker::start(Task task, Running running) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  const std::uint64_t ticket = ++s.wanted;
  if (running == Running::cancelled) s.news.reset();
  if (s.mode == Mode::immediate) {
    s.cancel = false;
    lock.unlock();
    return s.run(task, ticket);
  }
  if (running == Running::cancelled || (running == Running::alternating && s.busy && !s.spared)) {
    s.dropped = ticket - 1;
    s.cancel = true;
  }
  s.next = std::move(task);
  if (!thread_.started())
    thread_ = Worker([state = state_](const std::stop_token& stop) { state->work(stop); });
  lock.unlock();
  s.wake.notify_one();
}

void BackgroundWorker::cancel() {
  const std::lock_guard lock(state_->mutex);
  state_->cancel = true;
  state_->stopped = state_->wanted;
}

std::optional<BackgroundWorker::News> BackgroundWorker::take() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->news, std::nullopt);
}

bool BackgroundWorker::running() const {
  const std::lock_guard lock(state_->mutex);
  return state_->done < state_->wanted;
}

Progress BackgroundWorker::progress() const {
  return {state_->phase, state_->part};
}

double BackgroundWorker::seconds() const {
  return std::chrono::duration<double>(Clock::now() - state_->begun.load()).count();
}

void BackgroundWorker::State::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex);
  while (wake.wait(lock, stop, [this] { return next.has_value(); })) {
    if (stop.stop_requested()) return;
    const Task task = *std::exchange(next, std::nullopt);
    const std::uint64_t ticket = wanted;
    cancel = ended || ticket <= stopped;
    busy = true;
    lock.unlock();
    run(task, ticket);
    lock.lock();
    busy = false;
    spared = ticket <= dropped;
  }
}

void BackgroundWorker::State::run(const Task& task, std::uint64_t ticket) {
  part = 0;
  phase = "";
  begun = Clock::now();
  News last;
  const Interruptible scope(&cancel);
  try {
    last.result = task({.cancel = cancel,
                        .progress =
                            [this](const Progress& now) {
                              phase = now.phase;
                              if (now.part >= 0) part = std::min(now.part, 1.);
                            },
                        .publish =
                            [&](std::shared_ptr<void> so_far) {
                              deliver(ticket, {std::move(so_far), {}}, false);
                            }});
  } catch (const Interrupted& interrupted) {
    last.problem = interrupted.what();
    last.stopped = true;
  } catch (const std::exception& error) {
    last.problem = error.what();
  }
  deliver(ticket, std::move(last), true);
}

void BackgroundWorker::State::deliver(std::uint64_t ticket, News fresh, bool last) {
  {
    const std::lock_guard lock(mutex);
    if (ended || ticket <= dropped) return;
    if (last) done = ticket;
    news = std::move(fresh);
  }
  on_news();
}

} // namespace flyball
