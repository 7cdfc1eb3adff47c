// How long a command may take by the clock on the wall.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace CLI {
class App;
}

namespace flyball::cli {

inline constexpr double usual_time_limit = 60; // s

// --time-limit S.
void add_time_limit(CLI::App& command, double& seconds);

// A flag that is set when the time is over, for whatever can be cancelled.
class TimeLimit {
 public:
  // s from now on.
  explicit TimeLimit(double seconds);
  ~TimeLimit(); // waits for nothing
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

  const std::atomic<bool>& over() const { return over_; }

 private:
  std::atomic<bool> over_{false};
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_; // last, so that it ends before what it uses
};

} // namespace flyball::cli
