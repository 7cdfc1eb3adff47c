#include "engine/study/message_sharing.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/block_queue.hpp"

#include <cstring>
#include <deque>
#include <thread>

namespace flyball {
namespace {

// A message is one of these, and what belongs to it.
enum class Kind : char {
  ready,   // to the first: a block can be made
  block,   // from it: to be made; to it: as made, whoever sends it is ready for another
  failure, // to it: where, zero, expected
  stop,    // from it: an answer to each `ready` and `block` once there is nothing more to do
};

constexpr int in_hand = 3; // blocks that a process has asked for: the one being made, and the next ones

std::string message(Kind kind, const IndexBlock& block = {}, std::string_view bytes = {}) {
  std::string out(1 + sizeof block + bytes.size(), static_cast<char>(kind));
  std::memcpy(out.data() + 1, &block, sizeof block);
  bytes.copy(out.data() + 1 + sizeof block, bytes.size());
  return out;
}

Kind kind_of(const std::string& message) {
  return static_cast<Kind>(message.at(0));
}

IndexBlock block_of(const std::string& message) {
  IndexBlock block;
  std::memcpy(&block, message.data() + 1, sizeof block);
  return block;
}

std::string bytes_of(std::string message) {
  return std::move(message.erase(0, 1 + sizeof(IndexBlock)));
}

std::exception_ptr failure_of(const std::string& message) {
  const std::string bytes = message.substr(1 + sizeof(IndexBlock));
  const std::size_t zero = bytes.find('\0');
  return std::make_exception_ptr(SceneError(bytes.substr(0, zero), bytes.substr(zero + 1)));
}

} // namespace

MessageSharing::~MessageSharing() {
  if (ran_) return;
  try {
    SharedWork none; // nobody waits for this process
    none.maker = []() -> BlockMaker {
      throw std::runtime_error("one of the processes ended before its work");
    };
    run(none);
  } catch (const std::exception&) { // this process has told what it ends for
  }
}

void MessageSharing::run(const SharedWork& work) {
  ran_ = true;
  if (takes())
    serve(work);
  else
    make(work);
}

void MessageSharing::serve(const SharedWork& work) {
  const int others = passing_.size() - 1;
  BlockQueue queue(work, static_cast<std::size_t>(passing_.size()));
  std::deque<int> ready; // processes that wait for an answer, once for each
  int answers = in_hand * others;
  const auto handle = [&](MessagePassing::Message m) {
    const Kind kind = kind_of(m.bytes);
    if (kind == Kind::failure) return queue.stop(failure_of(m.bytes));
    ready.push_back(m.from);
    if (kind != Kind::block) return;
    const IndexBlock block = block_of(m.bytes);
    queue.put(block, bytes_of(std::move(m.bytes)));
  };
  const auto answer = [&] {
    IndexBlock block;
    for (BlockQueue::Next next{}; !ready.empty() && (next = queue.next(block)) != BlockQueue::Next::later;) {
      answers -= next == BlockQueue::Next::none;
      passing_.send(ready.front(), message(next == BlockQueue::Next::none ? Kind::stop : Kind::block, block));
      ready.pop_front();
    }
  };
  {
    const std::jthread own([&] { queue.make(work); });
    constexpr double moment = 0.001; // s, from one look for messages to the next
    do {
      while (auto m = passing_.receive(false))
        handle(std::move(*m));
      answer();
    } while (queue.deliver(work, moment));
    queue.stop();
    // All others have to be told; what they made meanwhile is not wanted.
    answer();
    while (answers > 0) {
      handle(*passing_.receive(true));
      answer();
    }
  }
  queue.rethrow();
}

void MessageSharing::make(const SharedWork& work) {
  for (int i = 0; i < in_hand; ++i)
    passing_.send(0, message(Kind::ready));
  BlockMaker maker;
  bool failed = false;
  for (int open = in_hand; open > 0;) {
    const std::string order = passing_.receive(true)->bytes;
    if (kind_of(order) == Kind::stop) {
      --open;
      continue;
    }
    const IndexBlock block = block_of(order);
    std::string bytes;
    try {
      if (!failed && !maker) maker = work.maker();
      if (!failed) bytes = maker(block.begin, block.end);
    } catch (const SceneError& error) {
      failed = true;
      passing_.send(0, message(Kind::failure, {}, error.where() + '\0' + error.expected()));
    } catch (const std::exception& error) {
      failed = true;
      passing_.send(0, message(Kind::failure, {}, std::string(1, '\0') + error.what()));
    }
    passing_.send(0, failed ? message(Kind::ready) : message(Kind::block, block, bytes));
  }
}

} // namespace flyball
