// How soon a computation ends when it is asked to: by the processor time of its thread, which does not depend
// on what else the machine does.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <optional>
#include <pthread.h>
#include <thread>

namespace flyball::test {

// `work` (with the flag as const std::atomic<bool>&) runs on a thread of its own and is asked to stop when it
// has used `after` seconds of the processor. Returns how much it uses from then on (s), or nothing where it
// came to its end before.
template <class Work>
std::optional<double> time_to_stop(double after, const Work& work) {
  std::atomic<bool> cancel{false}, ended{false};
  double at_end = 0;
  const auto seconds = [](clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  std::atomic<bool> read{false}; // the thread stays until its clock need not be read any more
  std::thread thread([&] {
    work(cancel);
    at_end = seconds(CLOCK_THREAD_CPUTIME_ID);
    ended = true;
    while (!read)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  clockid_t clock{};
  pthread_getcpuclockid(thread.native_handle(), &clock);
  while (!ended && seconds(clock) < after)
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  const bool in_time = !ended;
  cancel = true;
  const double asked = seconds(clock);
  read = true;
  thread.join();
  if (!in_time) return std::nullopt;
  return std::max(0., at_end - asked);
}

} // namespace flyball::test
