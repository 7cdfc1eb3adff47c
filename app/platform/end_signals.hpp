// Signals that ask the program to end: noticed without interrupting what is under way, and obeyed in any
// case.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace flyball {

// While it lives, SIGINT, SIGTERM and SIGHUP (unless they are ignored, as under nohup) are noted rather than
// end the program at once. Only one at a time.
class EndSignals {
 public:
  // `wake` tells whoever runs the loop that came() has changed. Where the loop does not end within `patience`
  // seconds, or at a second signal, `keep` is called and the signal takes its usual course. Both are called
  // from a thread of this object's own.
  EndSignals(std::function<void()> wake, std::function<void()> keep, double patience = 2);
  // The former course of signals again; one that came takes it when this object is gone.
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  // The signal that came, or 0.
  int came() const { return came_; }

 private:
  void listen();

  std::function<void()> wake_, keep_;
  double patience_;
  std::atomic<int> came_ = 0;
  std::thread thread_;
};

// Puts signals to end off until what is under way has been tidied up; then they take their usual course. Only
// one at a time.
class EndSignalsPutOff {
 public:
  EndSignalsPutOff();
  ~EndSignalsPutOff();
  EndSignalsPutOff(const EndSignalsPutOff&) = delete;
  EndSignalsPutOff& operator=(const EndSignalsPutOff&) = delete;

  static bool came_one();
};

} // namespace flyball
