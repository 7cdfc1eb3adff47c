#include "app/live/background.hpp"
#include "tests/catch.hpp"

#include <chrono>
#include <stdexcept>

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
int endless(const Numbers::Watch& watch) {
  while (!watch.cancel)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return -1;
}

} // namespace

TEST_CASE("a task's result, problem and progress come back") {
  for (const auto mode : {LiveSolver::Mode::background, LiveSolver::Mode::immediate}) {
    Numbers background(mode);
    CHECK_FALSE(background.running());
    background.start([](const Numbers::Watch& watch) {
      watch.progress({"counting", 0.5});
      return 7;
    });
    CHECK(wait_for(background).result == 7);
    CHECK(background.progress().part == 0.5);
    CHECK(std::string(background.progress().phase) == "counting");
    CHECK_FALSE(background.running());
    CHECK_FALSE(background.take());
    background.start([](const Numbers::Watch&) -> int { throw std::runtime_error("no such thing"); });
    const Numbers::News failed = wait_for(background);
    CHECK_FALSE(failed.result);
    CHECK(failed.problem == "no such thing");
  }
}

TEST_CASE("a newer task cancels the one that runs, whose result is dropped") {
  Numbers background(LiveSolver::Mode::background);
  background.start(endless);
  background.start([](const Numbers::Watch&) { return 8; });
  CHECK(wait_for(background).result == 8);
  CHECK_FALSE(background.running());
}

TEST_CASE("a task that is to wait lets the one that runs finish") {
  Numbers background(LiveSolver::Mode::background);
  std::atomic<bool> go{false}, begun{false};
  background.start([&](const Numbers::Watch&) {
    begun = true;
    while (!go)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 1;
  });
  while (!begun)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  background.start([](const Numbers::Watch&) { return 2; }, true);
  background.start([](const Numbers::Watch&) { return 3; }, true); // replaces the one that has not begun
  go = true;
  const auto first = wait_for(background);
  CHECK((first.result == 1 || first.result == 3));
  if (first.result == 1) CHECK(wait_for(background).result == 3);
  CHECK_FALSE(background.running());
}

TEST_CASE("a cancelled task gives what it has") {
  Numbers background(LiveSolver::Mode::background);
  background.start(endless);
  CHECK(background.running());
  background.cancel();
  CHECK(wait_for(background).result == -1);
}

TEST_CASE("what runs at the end is cancelled") {
  Numbers background(LiveSolver::Mode::background);
  background.start(endless);
}
