#include "engine/study/block_queue.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

constexpr std::size_t blocks_per_maker = 16; // of a small range
constexpr std::size_t waiting_per_maker = 4; // blocks, and at least so many
constexpr std::size_t indices_waiting = 32;  // indices, which may take very different times

} // namespace

BlockQueue::BlockQueue(const SharedWork& work, std::size_t makers)
    : count_(work.count),
      size_(std::clamp<std::size_t>(work.count / (blocks_per_maker * makers), 1, work.largest_block)),
      ahead_(makers * std::max(waiting_per_maker * size_, indices_waiting)) {}

BlockQueue::Next BlockQueue::next_locked(IndexBlock& block) {
  if (stopped_ || given_until_ == count_) return Next::none;
  if (given_until_ >= taken_until_ + ahead_) return Next::later;
  block = {given_until_, std::min(count_, given_until_ + size_)};
  given_until_ = block.end;
  return Next::block;
}

BlockQueue::Next BlockQueue::next(IndexBlock& block) {
  const std::lock_guard lock(mutex_);
  return next_locked(block);
}

bool BlockQueue::wait_for_next(IndexBlock& block) {
  std::unique_lock lock(mutex_);
  for (;;) {
    const Next found = next_locked(block);
    if (found != Next::later) return found == Next::block;
    taken_.wait(lock);
  }
}

void BlockQueue::put(const IndexBlock& block, std::string bytes) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(block.begin, std::pair(block.end, std::move(bytes)));
    made_count_ += block.end - block.begin;
  }
  made_.notify_one();
}

void BlockQueue::stop(std::exception_ptr failure) {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    if (failure && !failure_) failure_ = std::move(failure);
  }
  made_.notify_all();
  taken_.notify_all();
}

bool BlockQueue::take(double seconds, IndexBlock& block, std::string& bytes) {
  {
    std::unique_lock lock(mutex_);
    const auto is_there = [&] { return !waiting_.empty() && waiting_.begin()->first == taken_until_; };
    if (taken_until_ < count_)
      made_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return stopped_ || is_there(); });
    if (stopped_ || !is_there()) return false;
    auto first = waiting_.extract(waiting_.begin());
    block = {first.key(), first.mapped().first};
    bytes = std::move(first.mapped().second);
    taken_until_ = block.end;
  }
  taken_.notify_all();
  return true;
}

void BlockQueue::make(const SharedWork& work) noexcept {
  try {
    const BlockMaker maker = work.maker();
    for (IndexBlock block; wait_for_next(block);)
      put(block, maker(block.begin, block.end));
  } catch (...) {
    stop(std::current_exception());
  }
}

bool BlockQueue::deliver(const SharedWork& work, double seconds) noexcept {
  try {
    IndexBlock block;
    for (std::string bytes; take(seconds, block, bytes); seconds = 0) {
      if (work.cancel && work.cancel->load(std::memory_order_relaxed)) break; // it may be half of one
      work.take(block.begin, block.end, bytes);
    }
    if (work.cancel && work.cancel->load(std::memory_order_relaxed)) stop();
    std::unique_lock lock(mutex_);
    const std::size_t made = made_count_;
    const bool more = !stopped_ && taken_until_ < count_;
    lock.unlock();
    if (work.progress) work.progress(made, count_);
    return more;
  } catch (...) {
    stop(std::current_exception());
    return false;
  }
}

void BlockQueue::rethrow() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

} // namespace flyball
