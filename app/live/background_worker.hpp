// Long computations on a thread of their own while whoever asks goes on: one at a time, the newest wins, and
// nobody waits for one that is no longer wanted.
#pragma once

#include "app/live/worker.hpp"
#include "engine/task/progress.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace flyball {

class BackgroundWorker {
 public:
  enum class Mode {
    background, // on a thread of its own
    immediate,  // before start() returns: for pictures and tests, which come out the same every time
  };
  // What becomes of the task that runs when another is started. One that has not begun is replaced.
  enum class Running {
    cancelled,   // and nothing of it is taken any more, nor what was found before
    finished,    // and taken first, so that something new is seen however often a hand asks
    alternating, // cancelled, but for one that follows a cancelled one: every other task comes to its end,
                 // however long a task takes
  };
  // As it comes from a task, see Background for the types.
  struct News {
    std::shared_ptr<void> result; // null where there is a problem
    std::string problem;          // what the task threw
    bool stopped = false;         // by cancel() or a newer task, before it had a result
  };
  struct Context {
    const std::atomic<bool>& cancel; // becomes true when the result is not wanted any more
    ReportProgress progress;
    std::function<void(std::shared_ptr<void>)> publish; // a result so far, as news
  };
  // Must own what it uses: it goes on for a moment when the worker is gone.
  using Task = std::function<std::shared_ptr<void>(const Context&)>;

  // `on_news` is called on the background thread whenever there is something to take, and not after this
  // object is gone.
  explicit BackgroundWorker(Mode mode, std::function<void()> on_news = {});
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  void start(Task task, Running running = Running::cancelled);
  // The result comes all the same, of what was done until then, if the task gives one.
  void cancel();
  // The newest, once.
  std::optional<News> take();
  // Whether an answer to the newest task is still to come.
  bool running() const;
  // Of the task that runs, or ran last; `part` is 0 until something is reported.
  Progress progress() const;
  // How long that has run, s.
  double seconds() const;

 private:
  struct State;
  std::shared_ptr<State> state_; // shared with the thread, which may come to its end later
  Worker thread_;                // made with the first task
};

} // namespace flyball
