// A thread that nobody waits for. Where its result is no longer wanted it is asked to stop and left behind:
// it owns all that it uses, and is joined in the background when it has come to its end.
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace flyball {

class Worker {
 public:
  Worker() = default; // no thread
  // `work` must own, or share in owning, whatever it uses: it may outlive this object.
  explicit Worker(std::function<void(const std::stop_token&)> work);
  ~Worker();
  Worker(Worker&&) = default;
  Worker& operator=(Worker&& other) noexcept;

  bool started() const { return thread_.joinable(); }

 private:
  std::jthread thread_;
};

// Waits until every thread that was left behind has come to its end, `seconds` at most. False where one still
// runs: then the process must end without destroying what that may use (std::_Exit).
bool join_left_behind(double seconds);

// A callback that can be taken away from threads that outlive whoever gave it.
class Callback {
 public:
  explicit Callback(std::function<void()> call) : call_(std::move(call)) {}

  void operator()() {
    const std::lock_guard lock(mutex_);
    if (call_) call_();
  }
  // Never calls again. Where a call is under way on another thread its end is waited for.
  void silence() {
    const std::lock_guard lock(mutex_);
    call_ = nullptr;
  }

 private:
  std::mutex mutex_;
  std::function<void()> call_;
};

} // namespace flyball
