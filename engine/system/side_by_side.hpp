// Work that goes on at once on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace flyball {

// Calls work(i) for all i below `count`, in any order, on as many threads as there are cores. Throws what the
// work throws, when all have ended.
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work);

} // namespace flyball
