#include "app/live/worker.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <system_error>

namespace flyball {

namespace {

// Joins what was left behind, one thread after the other, on a thread of its own.
class Reaper {
 public:
  Reaper() = default;
  ~Reaper() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
  }
  Reaper(const Reaper&) = delete;
  Reaper& operator=(const Reaper&) = delete;

  void take(std::jthread thread) {
    {
      const std::lock_guard lock(mutex_);
      left_.push_back(std::move(thread));
      if (!thread_.joinable()) thread_ = std::jthread([this] { work(); });
    }
    wake_.notify_all();
  }

  bool wait(double seconds) {
    std::unique_lock lock(mutex_);
    return idle_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return left_.empty(); });
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return ending_ || !left_.empty(); });
      if (left_.empty()) return;
      std::jthread& first = left_.front(); // stays where it is: nobody else takes any away
      lock.unlock();
      first.join();
      lock.lock();
      left_.pop_front();
      if (left_.empty()) idle_.notify_all();
    }
  }

  std::mutex mutex_; // guards all below
  std::condition_variable wake_, idle_;
  std::deque<std::jthread> left_;
  bool ending_ = false;
  std::jthread thread_; // last, so that it ends before what it uses
};

// One for the process: threads outlive the windows and studies that began them.
Reaper& reaper() {
  static Reaper one;
  return one;
}

void leave_behind(std::jthread thread) {
  if (!thread.joinable()) return;
  thread.request_stop();
  reaper().take(std::move(thread));
}

} // namespace

Worker::Worker(std::function<void(const std::stop_token&)> work) : thread_(std::move(work)) {}

Worker::~Worker() {
  leave_behind(std::move(thread_));
}

Worker& Worker::operator=(Worker&& other) noexcept {
  leave_behind(std::exchange(thread_, std::move(other.thread_)));
  return *this;
}

bool join_left_behind(double seconds) {
  return reaper().wait(seconds);
}

} // namespace flyball
