#include "app/live/background.hpp"
#include "engine/linear/interruption.hpp"
#include "tests/catch.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

using namespace flyball;

namespace {

using Numbers = Background<int>;

Numbers::News wait_for(Numbers& background) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < limit) {
    if (auto news = background.take()) return *news;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  FAIL("nothing came within a minute");
  return {};
}

// Runs until it is cancelled.
int endless(const TaskContext<int>& context) {
  while (!context.cancel)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return -1;
}

} // namespace

TEST_CASE("a task's result, problem and progress come back") {
  for (const auto mode : {BackgroundWorker::Mode::background, BackgroundWorker::Mode::immediate}) {
    Numbers background(mode);
    CHECK_FALSE(background.running());
    background.start([](const TaskContext<int>& context) {
      context.progress({"counting", 0.5});
      return 7;
    });
    CHECK(*wait_for(background).result == 7);
    CHECK(background.progress().part == 0.5);
    CHECK(std::string(background.progress().phase) == "counting");
    CHECK_FALSE(background.running());
    CHECK_FALSE(background.take());
    background.start([](const TaskContext<int>&) -> int { throw std::runtime_error("no such thing"); });
    const Numbers::News failed = wait_for(background);
    CHECK_FALSE(failed.result);
    CHECK(failed.problem == "no such thing");
  }
}

TEST_CASE("a task that is interrupted before it has a result is told as stopped") {
  Numbers background(BackgroundWorker::Mode::background);
  background.start([](const TaskContext<int>& context) {
    const int result = endless(context);
    interruption_point();
    return result;
  });
  background.cancel();
  const Numbers::News news = wait_for(background);
  CHECK_FALSE(news.result);
  CHECK(news.stopped);
}

TEST_CASE("a newer task cancels the one that runs, whose result is dropped") {
  Numbers background(BackgroundWorker::Mode::background);
  background.start(endless);
  background.start([](const TaskContext<int>&) { return 8; });
  CHECK(*wait_for(background).result == 8);
  CHECK_FALSE(background.running());
}

TEST_CASE("a task that is to wait lets the one that runs finish") {
  Numbers background(BackgroundWorker::Mode::background);
  std::atomic<bool> go{false}, begun{false};
  background.start([&](const TaskContext<int>&) {
    begun = true;
    while (!go)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 1;
  });
  while (!begun)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  background.start([](const TaskContext<int>&) { return 2; }, Numbers::Running::finished);
  background.start([](const TaskContext<int>&) { return 3; },
                   Numbers::Running::finished); // replaces the one that has not begun
  go = true;
  const auto first = wait_for(background);
  CHECK((*first.result == 1 || *first.result == 3));
  if (*first.result == 1) CHECK(*wait_for(background).result == 3);
  CHECK_FALSE(background.running());
}

TEST_CASE("of tasks that take turns every other one comes to its end") {
  Numbers background(BackgroundWorker::Mode::background);
  std::atomic<int> begun{0};
  std::atomic<bool> go{false};
  // Ends when it is cancelled, or may go.
  const auto start = [&](int number) {
    const int before = begun;
    background.start(
        [&, number](const TaskContext<int>& context) {
          ++begun;
          while (!go && !context.cancel)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          return number;
        },
        Numbers::Running::alternating);
    return before;
  };
  const auto wait_for_begin = [&](int before) {
    while (begun == before)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  wait_for_begin(start(1));
  wait_for_begin(start(2)); // begins, as the first one is cancelled
  start(3);                 // waits for the second one
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(begun == 2);
  CHECK_FALSE(background.take());
  go = true;
  const auto first = wait_for(background);
  CHECK((*first.result == 2 || *first.result == 3));
  if (*first.result == 2) CHECK(*wait_for(background).result == 3);
  CHECK_FALSE(background.running());
}

TEST_CASE("what there is so far comes before the end, and none of it after a newer task was started") {
  Numbers background(BackgroundWorker::Mode::background);
  background.start([](const TaskContext<int>& context) {
    context.publish(4);
    return endless(context);
  });
  CHECK(*wait_for(background).result == 4);
  CHECK(background.running());
  background.cancel();
  CHECK(*wait_for(background).result == -1);
  std::atomic<bool> published{false};
  background.start([&](const TaskContext<int>& context) {
    context.publish(5);
    published = true;
    return endless(context);
  });
  while (!published)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  background.start([](const TaskContext<int>&) { return 6; });
  CHECK(*wait_for(background).result == 6);
}

TEST_CASE("a cancelled task gives what it has") {
  Numbers background(BackgroundWorker::Mode::background);
  background.start(endless);
  CHECK(background.running());
  background.cancel();
  CHECK(*wait_for(background).result == -1);
}

TEST_CASE("what runs at the end is cancelled") {
  Numbers background(BackgroundWorker::Mode::background);
  background.start(endless);
}
