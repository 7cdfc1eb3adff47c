// What is computed in the background because a person has asked for it: the request, and what was found for
// which one. Requests are values, so that whether something is up to date is a comparison.
#pragma once

#include "app/live/background.hpp"
#include "app/session/session_options.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace flyball {

template <class Request, class Result>
struct Study {
  struct Found {
    Request of;
    Result result;
    double run_time = 0;  // s
    bool stopped = false; // by the person, so that it is a part
  };
  using Find = std::function<Result(const Request&, const TaskContext<Result>&)>;
  using Running = BackgroundWorker::Running;

  std::optional<Request> asked; // last; none: nothing so far
  std::shared_ptr<Found> found; // last, perhaps for an earlier request; null: nothing
  std::string problem;          // why nothing was found for what was asked last

  // What was found before stays until there is something new.
  void ask(const SessionOptions& options, Request request, Find find, Running running = Running::cancelled) {
    asked = request;
    problem.clear();
    if (!task_) task_ = std::make_unique<Background<Found>>(options.mode, options.on_news);
    task_->start(
        [request = std::move(request), find = std::move(find)](const TaskContext<Found>& context) {
          const auto begin = std::chrono::steady_clock::now();
          const auto found_now = [&](Result result) {
            const std::chrono::duration<double> run_time = std::chrono::steady_clock::now() - begin;
            return Found{request, std::move(result), run_time.count(), context.cancel};
          };
          return found_now(find(request, {context.cancel, context.progress, [&](Result so_far) {
                                            context.publish(found_now(std::move(so_far)));
                                          }}));
        },
        running);
  }
  // Takes what has come; false where nothing has. With `stopped` a part is of no use, and that is the
  // problem.
  bool take(const char* stopped = nullptr) {
    auto news = task_ ? task_->take() : std::nullopt;
    if (!news) return false;
    problem = std::move(news->problem);
    if (stopped && (news->result ? news->result->stopped : news->stopped))
      problem = stopped;
    else if (news->result)
      found = std::move(news->result);
    return true;
  }
  // The person does not want to wait any longer: what there is comes as it is.
  void stop() {
    if (task_) task_->cancel();
  }

  bool is_of(const Request& now) const { return found && found->of == now; }
  // Whether it takes no time to speak of, so that it may be done anew after every change.
  bool quick() const { return found && found->run_time < 0.3; }

  // Of what was asked for last, see BackgroundWorker.
  bool running() const { return task_ && task_->running(); }
  Progress progress() const { return task_ ? task_->progress() : Progress{}; }
  double seconds() const { return task_ ? task_->seconds() : 0; }

 private:
  std::unique_ptr<Background<Found>> task_; // made when something is asked for
};

} // namespace flyball
