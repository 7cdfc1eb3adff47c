#include "engine/study/work_sharing.hpp"

#include "engine/study/block_queue.hpp"

#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

namespace flyball {

ThreadSharing::ThreadSharing(int threads)
    : threads_(threads > 0 ? static_cast<std::size_t>(threads)
                           : std::max(1U, std::thread::hardware_concurrency())) {}

void ThreadSharing::run(const SharedWork& work) {
  const std::size_t makers = std::clamp<std::size_t>(work.count, 1, threads_);
  BlockQueue queue(work, makers);
  {
    std::vector<std::jthread> threads;
    threads.reserve(makers); // nothing else is to throw while makers wait for what they made to be taken
    try {
      while (threads.size() < makers)
        threads.emplace_back([&] { queue.make(work); });
    } catch (const std::system_error&) { // no more to be had: those there are do it all
      if (threads.empty()) throw;
    }
    constexpr double patience = 0.02; // s, from one report of progress to the next
    while (queue.deliver(work, patience)) {
    }
    queue.stop(); // where one was thrown or cancelled
  }
  queue.rethrow();
}

} // namespace flyball
