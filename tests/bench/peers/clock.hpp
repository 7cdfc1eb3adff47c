// How long one call takes: the fastest and the median of batches long enough for the clock, in processor time
// of this thread, so that what else the machine does counts for little.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace flyball::peers {

struct Times {
  double fastest_s = 0, median_s = 0;
};

inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
Times time_of(Work work, double batch_s = 2e-3, int repeats = 41, double budget_s = 1) {
  const auto seconds = [&](long count) {
    const double begin = thread_seconds();
    for (long i = 0; i < count; ++i)
      work();
    return thread_seconds() - begin;
  };
  double spent = seconds(1);
  long count = 1;
  for (; spent < batch_s && count < 1L << 24; spent = seconds(count))
    count *= 2;
  std::vector<double> times{spent / static_cast<double>(count)};
  double all = spent;
  while (static_cast<int>(times.size()) < repeats && (all < budget_s || times.size() < 3)) {
    spent = seconds(count);
    all += spent;
    times.push_back(spent / static_cast<double>(count));
  }
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2]};
}

} // namespace flyball::peers
