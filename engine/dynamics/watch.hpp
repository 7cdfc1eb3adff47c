// Whether a long computation is still wanted and has time left: asked at every evaluation, inside steps too,
// for a single step may take as long as it likes.
#pragma once

#include <atomic>
#include <chrono>

namespace flyball {

class Watch {
 public:
  // `cancel` may be null.
  explicit Watch(const std::atomic<bool>* cancel = nullptr) : cancel_(cancel) {}

  // From now on so many seconds by the clock on the wall; infinite: no limit.
  void allow(double seconds) {
    limited_ = seconds < longest;
    if (limited_)
      end_ =
          Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }
  const std::atomic<bool>* flag() const { return cancel_; }
  bool cancelled() const { return cancel_ && cancel_->load(std::memory_order_relaxed); }
  bool out_of_time() const { return limited_ && Clock::now() >= end_; }
  bool over() const { return cancelled() || out_of_time(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double longest = 1e8; // s; beyond, the clock's own range comes into sight

  const std::atomic<bool>* cancel_;
  bool limited_ = false;
  Clock::time_point end_{};
};

} // namespace flyball
