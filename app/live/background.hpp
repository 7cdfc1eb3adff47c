// A BackgroundWorker for results of one type.
#pragma once

#include "app/live/background_worker.hpp"

#include <utility>

namespace flyball {

// What a task is given to look at and to report to.
template <class Result>
struct TaskContext {
  const std::atomic<bool>& cancel; // becomes true when the result is not wanted any more
  ReportProgress progress;
  std::function<void(Result)> publish; // a result so far
};

template <class Result>
class Background {
 public:
  using Running = BackgroundWorker::Running;
  struct News {
    std::shared_ptr<Result> result; // null where there is a problem
    std::string problem;            // what the task threw
    bool stopped = false;           // before it had a result
  };
  using Task = std::function<Result(const TaskContext<Result>&)>; // see BackgroundWorker

  explicit Background(BackgroundWorker::Mode mode, std::function<void()> on_news = {})
      : worker_(mode, std::move(on_news)) {}

  void start(Task task, Running running = Running::cancelled) {
    worker_.start(
        [task = std::move(task)](const BackgroundWorker::Context& context) -> std::shared_ptr<void> {
          return std::make_shared<Result>(
              task({context.cancel, context.progress,
                    [&](Result so_far) { context.publish(std::make_shared<Result>(std::move(so_far))); }}));
        },
        running);
  }
  void cancel() { worker_.cancel(); }
  std::optional<News> take() {
    auto news = worker_.take();
    if (!news) return std::nullopt;
    return News{std::static_pointer_cast<Result>(std::move(news->result)), std::move(news->problem),
                news->stopped};
  }
  bool running() const { return worker_.running(); }
  Progress progress() const { return worker_.progress(); }
  double seconds() const { return worker_.seconds(); }

 private:
  BackgroundWorker worker_;
};

} // namespace flyball
