// What a command is doing, on standard error, for a person at a terminal who has waited for over a second:
// "following a branch [==========      ] 62 %, 12 s". Wiped at the end.
#pragma once

#include "engine/task/progress.hpp"

#include <atomic>
#include <cstddef>
#include <thread>

namespace flyball::cli {

class ProgressBar {
 public:
  // `phase` says in a few words what is being done; a literal, as all phases are.
  explicit ProgressBar(const char* phase);
  ~ProgressBar(); // wipes it
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // May be called from any thread, as often as one likes: it is drawn ten times a second by a thread of its
  // own, also while nothing is reported.
  void show(const Progress& now);
  void show(const char* phase, std::size_t done, std::size_t all);
  // Of this object, for options that report.
  ReportProgress reporter() {
    return [this](const Progress& now) { show(now); };
  }

 private:
  void draw(double seconds);

  std::atomic<const char*> phase_;
  std::atomic<double> part_{-1};
  std::atomic<std::size_t> done_{0}, all_{0}; // 0 of 0: not counted
  bool drawn_ = false;                        // used by the thread, and when it has ended
  std::jthread thread_;                       // only at a terminal
};

} // namespace flyball::cli
