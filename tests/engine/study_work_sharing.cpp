// Shared work: the same bytes in the same order, whoever makes them, by threads and by processes that pass
// messages, here on threads, too.
#include "engine/mechanism/error.hpp"
#include "engine/study/block_queue.hpp"
#include "engine/study/message_sharing.hpp"
#include "tests/catch.hpp"

#include <chrono>
#include <deque>
#include <numeric>
#include <random>
#include <thread>

using namespace flyball;

namespace {

// Letters by index; some take their time.
std::string letters(std::size_t begin, std::size_t end) {
  std::string out;
  for (std::size_t i = begin; i < end; ++i)
    out += static_cast<char>('a' + i * i % 26);
  if (end % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
  return out;
}

struct Taken {
  std::string bytes;
  std::size_t progress = 0;

  SharedWork work(std::size_t count) {
    SharedWork out;
    out.count = count;
    out.maker = [] { return letters; };
    out.take = [this](std::size_t begin, std::size_t end, std::string_view block) {
      CHECK(begin == bytes.size());
      CHECK(end == begin + block.size());
      bytes += block;
    };
    out.progress = [this](std::size_t made, std::size_t) {
      CHECK(made >= progress);
      progress = made;
    };
    return out;
  }
};

// As many processes as threads, with a box of messages each.
class Boxes {
 public:
  explicit Boxes(int count) : boxes_(static_cast<std::size_t>(count)) {}
  int count() const { return static_cast<int>(boxes_.size()); }
  void send(int to, MessagePassing::Message message) {
    {
      const std::lock_guard lock(mutex_);
      boxes_[static_cast<std::size_t>(to)].push_back(std::move(message));
    }
    arrived_.notify_all();
  }
  std::optional<MessagePassing::Message> receive(int at, bool wait) {
    std::unique_lock lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(at)];
    if (wait) arrived_.wait(lock, [&] { return !box.empty(); });
    if (box.empty()) return {};
    auto message = std::move(box.front());
    box.pop_front();
    return message;
  }
  bool empty() const {
    return std::ranges::all_of(boxes_, [](const auto& box) { return box.empty(); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<std::deque<MessagePassing::Message>> boxes_;
};

class BoxPassing final : public MessagePassing {
 public:
  BoxPassing(Boxes& boxes, int rank) : boxes_(boxes), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return boxes_.count(); }
  void send(int to, std::string_view bytes) override { boxes_.send(to, {rank_, std::string(bytes)}); }
  std::optional<Message> receive(bool wait) override { return boxes_.receive(rank_, wait); }

 private:
  Boxes& boxes_;
  int rank_;
};

} // namespace

TEST_CASE("blocks are taken in order and whole, whatever the threads") {
  for (const std::size_t count : {0UL, 1UL, 7UL, 1000UL, 20'011UL})
    for (const int threads : {1, 2, 5}) {
      CAPTURE(count, threads);
      Taken taken;
      ThreadSharing(threads).run(taken.work(count));
      CHECK(taken.bytes == letters(0, count));
      CHECK(taken.progress == count);
    }
}

TEST_CASE("only so many blocks wait for one that is slow") {
  Taken taken;
  SharedWork work = taken.work(100'000);
  std::atomic<std::size_t> farthest = 0, meanwhile = 0;
  work.maker = [&farthest, &meanwhile] {
    return [&farthest, &meanwhile](std::size_t begin, std::size_t end) {
      if (begin == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        meanwhile = farthest.load();
      }
      farthest = std::max<std::size_t>(farthest, end);
      return letters(begin, end);
    };
  };
  ThreadSharing(3).run(work);
  CHECK(taken.bytes == letters(0, 100'000));
  CHECK(meanwhile > 0);
  CHECK(meanwhile <= 40'000);
}

TEST_CASE("what a maker or a taker throws ends the work") {
  for (const int threads : {1, 3}) {
    Taken taken;
    SharedWork work = taken.work(10'000);
    work.maker = [] {
      return [](std::size_t begin, std::size_t end) {
        if (end > 5000) throw SceneError("here", "expected less");
        return letters(begin, end);
      };
    };
    CHECK_THROWS_WITH(ThreadSharing(threads).run(work), "here: expected less");
    CHECK(taken.bytes == letters(0, taken.bytes.size()));
    work = Taken().work(10'000);
    work.progress = {};
    work.take = [](std::size_t, std::size_t, std::string_view) { throw std::runtime_error("full"); };
    CHECK_THROWS_WITH(ThreadSharing(threads).run(work), "full");
    Taken none;
    work = none.work(100);
    work.maker = []() -> BlockMaker { throw std::runtime_error("no maker"); };
    CHECK_THROWS_WITH(ThreadSharing(threads).run(work), "no maker");
  }
}

TEST_CASE("cancelled work ends, and half a block is not taken") {
  std::atomic<bool> cancel = false;
  Taken taken;
  SharedWork work = taken.work(1'000'000);
  work.cancel = &cancel;
  work.maker = [&cancel] {
    return [&cancel](std::size_t begin, std::size_t end) {
      if (begin > 3000) cancel = true;
      return cancel ? "half" : letters(begin, end);
    };
  };
  ThreadSharing(2).run(work);
  CHECK(taken.bytes == letters(0, taken.bytes.size()));
  CHECK(taken.bytes.size() < 100'000);
}

TEST_CASE("processes that pass messages give the same bytes as one") {
  for (const int processes : {1, 2, 5})
    for (const std::size_t count : {0UL, 3UL, 20'011UL}) {
      CAPTURE(processes, count);
      Boxes boxes(processes);
      Taken taken;
      {
        std::vector<std::jthread> others;
        for (int rank = 1; rank < processes; ++rank)
          others.emplace_back([&boxes, rank, count] {
            BoxPassing passing(boxes, rank);
            MessageSharing sharing(passing);
            SharedWork work;
            work.count = count;
            work.maker = [] { return letters; };
            if (!sharing.takes()) sharing.run(work);
          });
        BoxPassing passing(boxes, 0);
        MessageSharing sharing(passing);
        CHECK(sharing.takes());
        sharing.run(taken.work(count));
      }
      CHECK(taken.bytes == letters(0, count));
      CHECK(boxes.empty());
    }
}

TEST_CASE("what is wrong in one process ends the work of all, and is told by the first") {
  enum class Wrong { maker, begins_not, first_begins_not };
  for (const Wrong wrong : {Wrong::maker, Wrong::begins_not, Wrong::first_begins_not}) {
    Boxes boxes(3);
    std::string told;
    {
      std::vector<std::jthread> others;
      for (int rank = 1; rank < 3; ++rank)
        others.emplace_back([&boxes, rank, wrong] {
          BoxPassing passing(boxes, rank);
          MessageSharing sharing(passing);
          if (wrong == Wrong::begins_not && rank == 2) return;
          SharedWork work;
          work.count = 100'000;
          work.maker = [rank, wrong] {
            return [rank, wrong](std::size_t begin, std::size_t end) {
              if (wrong == Wrong::maker && rank == 2) throw SceneError("there", "expected more");
              return letters(begin, end);
            };
          };
          sharing.run(work);
        });
      BoxPassing passing(boxes, 0);
      MessageSharing sharing(passing);
      Taken taken;
      try {
        if (wrong != Wrong::first_begins_not) sharing.run(taken.work(100'000));
      } catch (const std::exception& error) {
        told = error.what();
      }
    }
    if (wrong == Wrong::maker) CHECK(told == "there: expected more");
    if (wrong == Wrong::begins_not) CHECK_THAT(told, ContainsSubstring("ended before its work"));
    CHECK(boxes.empty());
  }
}
