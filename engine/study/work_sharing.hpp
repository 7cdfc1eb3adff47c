// Work over a range of indices that threads or processes share. Blocks of it are made by whoever is free and
// taken in order, so that what comes out does not tell who made it; no more of them wait to be taken than a
// few for each maker.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace flyball {

// Makes what is to be known of the indices from `begin` up to `end`, as bytes: the same whoever makes them.
using BlockMaker = std::function<std::string(std::size_t begin, std::size_t end)>;

struct SharedWork {
  std::size_t count = 0;            // of indices, from zero
  std::size_t largest_block = 1000; // indices; fewer where each takes its time or says a lot
  // Called by each thread that makes blocks, for what it keeps from one to the next.
  std::function<BlockMaker()> maker;
  // Called in order of the indices, by the thread that called run().
  std::function<void(std::size_t begin, std::size_t end, std::string_view block)> take =
      [](std::size_t, std::size_t, std::string_view) {};
  // Likewise, again and again, with the number of indices of which blocks are made.
  std::function<void(std::size_t made, std::size_t all)> progress{};
  const std::atomic<bool>* cancel = nullptr; // makers end early where it is set, and nothing more is taken
};

class WorkSharing {
 public:
  virtual ~WorkSharing() = default;
  // Returns when all is taken or work was cancelled. Throws what a maker or `take` threw first.
  virtual void run(const SharedWork& work) = 0;
  // Whether blocks are taken here: of several processes in one.
  virtual bool takes() const { return true; }
};

// By so many threads of this process, 0 for all cores that it may use.
class ThreadSharing final : public WorkSharing {
 public:
  explicit ThreadSharing(int threads = 0);
  void run(const SharedWork& work) override;

 private:
  std::size_t threads_;
};

} // namespace flyball
