// Work that goes on at once on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace flyball {

// For side_by_side().
void run_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work);

// Calls work(i) for all i below `count`, in any order, on as many threads as there are cores; a single one in
// this thread. Throws what the work throws, when all have ended.
template <class Work>
void side_by_side(std::size_t count, const Work& work) {
  if (count == 1)
    work(std::size_t{0});
  else
    run_on_all_cores(count, std::ref(work));
}

} // namespace flyball
