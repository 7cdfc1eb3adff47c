// Blocks of a range of indices on their way from those who make them, in any order, to the one who takes them
// in order. For any number of threads.
#pragma once

#include "engine/study/work_sharing.hpp"

#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <string>

namespace flyball {

struct IndexBlock {
  std::size_t begin = 0, end = 0;
};

class BlockQueue {
 public:
  // `makers`: how many make blocks at a time. Blocks are small enough for all to end at about the same time.
  BlockQueue(const SharedWork& work, std::size_t makers);

  enum class Next {
    block, // to be made now
    later, // what was made before has to be taken first
    none,  // all are given out, or work has stopped
  };
  Next next(IndexBlock& block);
  // Waits where it is later. False for none.
  bool wait_for_next(IndexBlock& block);
  void put(const IndexBlock& block, std::string bytes);

  // Gives no more out. The first exception is kept.
  void stop(std::exception_ptr failure = nullptr);

  // Takes what is made and next in order, for which it waits up to so many seconds. False where there is
  // none.
  bool take(double seconds, IndexBlock& block, std::string& bytes);

  // Makes blocks until there are no more, on this thread.
  void make(const SharedWork& work) noexcept;
  // Takes all that can be taken, waits up to so many seconds for the first, and tells how far things are.
  // False where that was the last or work has stopped.
  bool deliver(const SharedWork& work, double seconds) noexcept;
  void rethrow() const; // the exception, where there is one

 private:
  Next next_locked(IndexBlock& block);

  const std::size_t count_, size_,
      ahead_; // indices: of all, of a block, from what was taken to what is given
  mutable std::mutex mutex_;
  std::condition_variable made_, taken_;
  std::map<std::size_t, std::pair<std::size_t, std::string>> waiting_; // by their beginning: end, bytes
  std::size_t given_until_ = 0, taken_until_ = 0, made_count_ = 0;
  bool stopped_ = false;
  std::exception_ptr failure_;
};

} // namespace flyball
