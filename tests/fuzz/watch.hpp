// A deadline: sets a flag when the time is up, which everything that computes for long takes as `cancel`.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace flyball::fuzz {

class Watch {
 public:
  explicit Watch(std::chrono::milliseconds limit)
      : thread_([this, limit] {
          std::unique_lock lock(mutex_);
          if (!stop_.wait_for(lock, limit, [this] { return over_; })) expired_ = true;
        }) {}
  ~Watch() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    stop_.notify_one();
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  const std::atomic<bool>* expired() const { return &expired_; }

 private:
  std::atomic<bool> expired_ = false;
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable stop_;
  std::thread thread_;
};

} // namespace flyball::fuzz
