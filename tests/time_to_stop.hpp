// How soon a computation ends when it is asked to: by the processor time of this program with all its
// threads, which does not depend on what else the machine does.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <optional>
#include <thread>

namespace flyball::test {

// `work` (with the flag as const std::atomic<bool>&) runs beside this thread, and may take more threads. It
// is asked to stop when they have used `after` seconds of the processor. Returns how much they use from then
// on (s), or nothing where it came to its end before.
template <class Work>
std::optional<double> time_to_stop(double after, const Work& work) {
  const auto used = [] {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  std::atomic<bool> cancel{false}, ended{false};
  double at_end = 0;
  const double begun = used();
  std::thread thread([&] {
    work(cancel);
    at_end = used();
    ended = true;
  });
  while (!ended && used() - begun < after)
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  const bool in_time = !ended;
  const double asked = used();
  cancel = true;
  thread.join();
  if (!in_time) return std::nullopt;
  return std::max(0., at_end - asked);
}

} // namespace flyball::test
