// Points at which a long computation can be ended by another thread.
//
// Whoever is given a flag opens a scope with it, and catches what an interruption point throws when the flag
// is set. Between the two lie many calls, down to the decomposition of one large matrix, which need not know:
// the flag belongs to the thread while the scope is open, as in pthread_testcancel and Boost.Thread.
#pragma once

#include <atomic>
#include <exception>

namespace flyball {

// Set by another thread to end a computation; null where nobody may.
using CancelFlag = const std::atomic<bool>*;

inline bool is_cancelled(CancelFlag cancel) {
  return cancel && cancel->load(std::memory_order_relaxed);
}

// Thrown by interruption points; whoever opened the scope catches it and says that it was cancelled. Results
// that were being computed are of no use.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "Cancelled."; }
};

// As long as it lives interruption points of this thread look at the flag; with null at what was looked at
// before.
class Interruptible {
 public:
  explicit Interruptible(CancelFlag cancel) noexcept;
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  CancelFlag before_;
};

// As long as it lives interruption points of this thread do nothing: around calls of libraries that call back
// and that no exception may pass.
class Uninterrupted {
 public:
  Uninterrupted() noexcept;
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;

 private:
  CancelFlag before_;
};

// Throws Interrupted where the flag of the innermost scope of this thread is set. Costs nanoseconds.
void interruption_point();

} // namespace flyball
