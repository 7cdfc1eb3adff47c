#include "engine/system/side_by_side.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace flyball {

void run_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t i; (i = next++) < count;)
      work(i);
  };
  static const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> others;
  try {
    while (others.size() + 1 < std::min(cores, count))
      others.push_back(std::async(std::launch::async, take));
  } catch (const std::system_error&) { // no more threads to be had: those there are do it all
  }
  take();
  for (std::future<void>& other : others)
    other.get();
}

} // namespace flyball
