// Threads that nobody waits for: closing what runs one takes no time, whatever the thread is doing.
#include "app/live/background.hpp"
#include "app/live/live_solver.hpp"
#include "app/live/motion.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

using Clock = std::chrono::steady_clock;

// A task that looks at nothing until a gate is opened.
struct Gate {
  std::atomic<bool> open{false}, reached{false}, left{false};
  void pass() {
    reached = true;
    while (!open)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    left = true;
  }
  void wait_until_reached() const {
    while (!reached)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

} // namespace

TEST_CASE("closing a background does not wait for a task that does not listen") {
  const auto gate = std::make_shared<Gate>();
  auto news = std::make_shared<std::atomic<int>>(0);
  {
    Background<int> background(BackgroundWorker::Mode::background, [news] { ++*news; });
    background.start([gate](const TaskContext<int>&) {
      gate->pass();
      return 1;
    });
    gate->wait_until_reached();
  }
  // Had it been waited for this were never reached: nobody else opens the gate.
  CHECK_FALSE(gate->left);
  CHECK_FALSE(join_left_behind(0.02));
  gate->open = true;
  CHECK(join_left_behind(60));
  CHECK(gate->left);
  CHECK(*news == 0); // whoever asked is gone
}

TEST_CASE("what is closed is asked to stop, and what had not begun never begins") {
  const auto gate = std::make_shared<Gate>();
  const auto begun = std::make_shared<std::atomic<bool>>(false);
  const auto cancelled = std::make_shared<std::atomic<bool>>(false);
  {
    Background<int> background(BackgroundWorker::Mode::background);
    background.start([gate, cancelled](const TaskContext<int>& context) {
      gate->pass();
      *cancelled = context.cancel.load();
      return 1;
    });
    gate->wait_until_reached();
    background.start(
        [begun](const TaskContext<int>&) {
          *begun = true;
          return 2;
        },
        Background<int>::Running::finished);
  }
  gate->open = true;
  REQUIRE(join_left_behind(60));
  CHECK(*cancelled);
  CHECK_FALSE(*begun);
}

TEST_CASE("many that are closed while they run are all joined") {
  for (int i = 0; i < 50; ++i) {
    Background<int> background(BackgroundWorker::Mode::background);
    background.start([i](const TaskContext<int>& context) {
      while (!context.cancel)
        std::this_thread::yield();
      return i;
    });
  }
  CHECK(join_left_behind(60));
}

TEST_CASE("solvers and motions are closed while they compute") {
  const auto mechanism = std::make_shared<const Mechanism>(shipped("governor"));
  for (int i = 0; i < 5; ++i) {
    LiveSolver solver(BackgroundWorker::Mode::background);
    solver.ask({.mechanism = mechanism, .another = true});
    Background<Motion> motion(BackgroundWorker::Mode::background);
    MotionRequest request{.mechanism = mechanism, .options = {}, .before = nullptr};
    request.options.duration = 1e6;
    motion.start([request](const TaskContext<Motion>& context) { return compute_motion(request, context); });
    if (i % 2) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(join_left_behind(60));
}

TEST_CASE("a callback that was silenced is not called") {
  int calls = 0;
  Callback callback([&] { ++calls; });
  callback();
  callback.silence();
  callback();
  CHECK(calls == 1);
}
